//! COCO's JSON with `track_id`.

use std::collections::HashMap;

use serde::Deserialize;

use super::{Row, RowTrack, no_class, track_of};
use crate::geometry::Rect;

#[derive(Deserialize)]
struct Coco {
    images: Vec<Image>,
    annotations: Vec<Annotation>,
    #[serde(default)]
    categories: Vec<Category>,
}

#[derive(Deserialize)]
struct Image {
    id: u64,
    frame_id: Option<usize>,
}

#[derive(Deserialize)]
struct Category {
    id: u64,
    name: String,
}

#[derive(Deserialize)]
struct Annotation {
    image_id: u64,
    category_id: Option<u64>,
    bbox: [f64; 4],
    track_id: Option<u64>,
    score: Option<f64>,
    #[serde(default)]
    attributes: Attributes,
}

#[derive(Deserialize, Default)]
struct Attributes {
    track_id: Option<u64>,
    name: Option<String>,
    key: Option<bool>,
}

/// Images without `frame_id` are frames in their order.
pub(super) fn tracks(text: &str) -> Result<Vec<RowTrack>, String> {
    let Coco { images, annotations, categories } = serde_json::from_str(text)
        .map_err(|error| format!("is no COCO with images and annotations: {error}"))?;
    let frames: HashMap<u64, usize> =
        images.iter().enumerate().map(|(at, image)| (image.id, image.frame_id.unwrap_or(at))).collect();
    let classes: HashMap<u64, &str> =
        categories.iter().map(|category| (category.id, category.name.as_str())).collect();
    let mut tracks = Vec::new();
    for (at, annotation) in annotations.iter().enumerate() {
        let number = at + 1;
        let &frame = frames
            .get(&annotation.image_id)
            .ok_or_else(|| format!("annotation {number}: there is no image {}", annotation.image_id))?;
        let id = annotation.track_id.or(annotation.attributes.track_id).ok_or_else(|| {
            format!("annotation {number} has no track_id, so it is not known which boxes are one object")
        })?;
        let words = || {
            let class = annotation.category_id.and_then(|id| classes.get(&id));
            let name = annotation.attributes.name.clone();
            (name.unwrap_or_else(|| format!("object {id}")), class.map_or_else(no_class, ToString::to_string))
        };
        let [x, y, w, h] = annotation.bbox;
        let confidence = annotation.score.unwrap_or(1.0);
        let row = Row { rect: Rect::new(x, y, w, h), confidence, is_key: annotation.attributes.key };
        track_of(&mut tracks, id, words).rows.insert(frame, row);
    }
    Ok(tracks.into_iter().map(|(_, track)| track).collect())
}
