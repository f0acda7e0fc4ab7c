//! The walking person, seen from the side.

use std::f32::consts::PI;

use super::canvas::{Canvas, Colour, Point, Shape, lit};

/// Width of a person's box by its height.
pub(super) const ASPECT: f64 = 30.0 / 84.0;

/// Largest angle of a thigh from the vertical, radians.
const THIGH_SWING: f32 = 0.42;

/// Largest angle of an upper arm, radians.
const ARM_SWING: f32 = 0.38;

/// What a person wears.
#[derive(Debug, Clone, Copy)]
pub(super) struct Clothes {
    pub(super) shirt: [Colour; 2],
    pub(super) trousers: Colour,
    pub(super) hair: Colour,
}

/// The person to be tracked.
pub(super) const WALKER: Clothes = Clothes {
    shirt: [[176.0, 44.0, 48.0], [226.0, 214.0, 190.0]],
    trousers: [52.0, 64.0, 104.0],
    hair: [58.0, 40.0, 28.0],
};

/// Somebody in other clothes.
pub(super) const STRANGER: Clothes = Clothes {
    shirt: [[54.0, 96.0, 132.0], [60.0, 70.0, 84.0]],
    trousers: [120.0, 108.0, 88.0],
    hair: [140.0, 110.0, 70.0],
};

const SKIN: Colour = [206.0, 160.0, 130.0];
const SHOE: Colour = [40.0, 34.0, 32.0];

/// Where a person stands and how far through a pair of steps.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pose {
    /// Between the feet, on the ground, pixels.
    pub(super) foot: Point,
    /// From sole to crown, pixels.
    pub(super) height: f32,
    /// Angle in the cycle of two steps, radians.
    pub(super) phase: f32,
    /// How far the limbs swing: 1 in walking, 0 in standing still.
    pub(super) swing: f32,
}

/// Paints a person, who walks to the right, and the shadow on the ground.
pub(super) fn draw(canvas: &mut Canvas, pose: &Pose, clothes: &Clothes) {
    let body = Body::new(pose);
    body.shadow(canvas);
    body.arm(canvas, pose.swing * pose.phase.sin(), lit(clothes.shirt[0], 0.6), 0.7);
    body.leg(canvas, &Leg::new(pose.phase + PI, pose.swing), lit(clothes.trousers, 0.68));
    body.leg(canvas, &Leg::new(pose.phase, pose.swing), clothes.trousers);
    body.torso(canvas, clothes);
    body.head(canvas, clothes.hair);
    body.arm(canvas, -pose.swing * pose.phase.sin(), lit(clothes.shirt[0], 0.92), 1.0);
}

/// A person's own coordinates: 0 at the crown, 1 at the sole, x forwards, all in body heights.
struct Body {
    origin: Point,
    height: f32,
    foot: Point,
}

/// A leg's joints, in body heights.
struct Leg {
    knee: Point,
    ankle: Point,
    shin_angle: f32,
}

impl Leg {
    /// The knee bends while the thigh swings forward.
    fn new(phase: f32, swing: f32) -> Self {
        let thigh_angle = swing * THIGH_SWING * phase.sin();
        let bend = swing * (0.06 + 0.85 * phase.cos().max(0.0).powi(2));
        let knee = step(HIP, thigh_angle, THIGH);
        let shin_angle = thigh_angle - bend;
        Self { knee, ankle: step(knee, shin_angle, STANDING_ANKLE - HIP.1 - THIGH), shin_angle }
    }
}

const HIP: Point = (0.0, 0.505);
const SHOULDER: Point = (0.0, 0.22);
const STANDING_ANKLE: f32 = 0.965;
const THIGH: f32 = 0.235;

impl Body {
    /// The body sinks while the legs are spread, for one foot is always on the ground.
    fn new(pose: &Pose) -> Self {
        let lowest =
            Leg::new(pose.phase, pose.swing).ankle.1.max(Leg::new(pose.phase + PI, pose.swing).ankle.1);
        let sunk = STANDING_ANKLE - lowest;
        let origin = (pose.foot.0, pose.foot.1 + (sunk - 1.0) * pose.height);
        Self { origin, height: pose.height, foot: pose.foot }
    }

    fn at(&self, (x, y): Point) -> Point {
        (self.origin.0 + x * self.height, self.origin.1 + y * self.height)
    }

    fn own(&self, (x, y): Point) -> Point {
        ((x - self.origin.0) / self.height, (y - self.origin.1) / self.height)
    }

    fn limb(&self, canvas: &mut Canvas, from: Point, to: Point, radii: (f32, f32), colour: Colour) {
        let (a, b) = (self.at(from), self.at(to));
        let shape = Shape::Capsule { a, b, ra: radii.0 * self.height, rb: radii.1 * self.height };
        canvas.fill(&shape, 1.0, |_| colour);
    }

    fn shadow(&self, canvas: &mut Canvas) {
        let centre = (self.foot.0 - 0.05 * self.height, self.foot.1 - 0.005 * self.height);
        let shape = Shape::Ellipse { centre, rx: 0.24 * self.height, ry: 0.035 * self.height };
        canvas.fill(&shape, 0.35, |_| [30.0, 30.0, 36.0]);
    }

    fn leg(&self, canvas: &mut Canvas, leg: &Leg, colour: Colour) {
        let &Leg { knee, ankle, shin_angle } = leg;
        let (heel, toe) = (ankle, step(ankle, shin_angle + 1.45, 0.085));
        self.limb(canvas, (heel.0 - 0.008, heel.1 + 0.012), (toe.0, toe.1 + 0.008), (0.026, 0.018), SHOE);
        self.limb(canvas, HIP, knee, (0.066, 0.047), colour);
        self.limb(canvas, knee, ankle, (0.045, 0.03), lit(colour, 0.94));
    }

    /// `forward` runs from -1, swung back, to 1.
    fn arm(&self, canvas: &mut Canvas, forward: f32, sleeve: Colour, gain: f32) {
        let angle = ARM_SWING * forward;
        let elbow = step(SHOULDER, angle, 0.155);
        let hand = step(elbow, angle + 0.3 + 0.25 * forward, 0.14);
        self.limb(canvas, elbow, hand, (0.03, 0.024), lit(SKIN, gain));
        self.limb(canvas, SHOULDER, elbow, (0.043, 0.036), sleeve);
    }

    fn torso(&self, canvas: &mut Canvas, clothes: &Clothes) {
        let (a, b) = (self.at((0.004, 0.25)), self.at((0.0, 0.465)));
        let shape = Shape::Capsule { a, b, ra: 0.094 * self.height, rb: 0.08 * self.height };
        let neck = ((0.004, 0.13), (0.0, 0.18));
        self.limb(canvas, neck.0, neck.1, (0.036, 0.038), lit(SKIN, 0.82));
        canvas.fill(&shape, 1.0, |point| {
            let (x, y) = self.own(point);
            let stripe = (y / 0.038).floor() as i32;
            let checked = stripe.rem_euclid(4) == 3 && (x / 0.04).floor() as i32 % 2 == 0;
            let colour = clothes.shirt[usize::from(stripe.rem_euclid(2) == 1 && !checked)];
            lit(colour, shade(x / 0.09))
        });
        self.limb(canvas, (-0.066, 0.528), (0.066, 0.528), (0.014, 0.014), lit(SHOE, 1.2));
    }

    fn head(&self, canvas: &mut Canvas, hair: Colour) {
        let centre = self.at((0.014, 0.078));
        let shape = Shape::Ellipse { centre, rx: 0.06 * self.height, ry: 0.076 * self.height };
        canvas.fill(&shape, 1.0, |point| {
            let (x, y) = self.own(point);
            let hairline = 0.05 + 0.9 * (0.03 - x).max(0.0);
            if y < hairline { lit(hair, shade(x / 0.07)) } else { lit(SKIN, shade((x - 0.01) / 0.07)) }
        });
        let eye = Shape::Ellipse {
            centre: self.at((0.05, 0.073)),
            rx: 0.009 * self.height,
            ry: 0.009 * self.height,
        };
        canvas.fill(&eye, 0.8, |_| SHOE);
    }
}

/// The end of a limb that hangs from `from`, swung forward by `angle` radians.
fn step(from: Point, angle: f32, length: f32) -> Point {
    (from.0 + length * angle.sin(), from.1 + length * angle.cos())
}

/// Brightness across a round body, lit from the front: `across` is -1 at the back and 1 at the front.
fn shade(across: f32) -> f32 {
    0.9 + 0.14 * across.clamp(-1.0, 1.0) - 0.12 * across.clamp(-1.0, 1.0).powi(2)
}
