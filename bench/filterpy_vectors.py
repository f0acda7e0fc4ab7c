#!/usr/bin/env python3
"""Writes tests/data/filterpy.json: what filterpy's Kalman filters make of fixed models and measurements.

    pip install filterpy==1.4.5 numpy scipy
    bench/filterpy_vectors.py

tests/bayes_filterpy.rs compares the project's filters with it. The numbers are data of the tests: run this again only
to add a case.
"""

import json
import pathlib

import numpy as np
from filterpy.kalman import (
    ExtendedKalmanFilter,
    JulierSigmaPoints,
    KalmanFilter,
    MerweScaledSigmaPoints,
    UnscentedKalmanFilter,
)

OUT = pathlib.Path(__file__).resolve().parent.parent / "tests" / "data" / "filterpy.json"
STEPS = 40


def record(steps, kf):
    steps.append(
        {
            "mean": np.ravel(kf.x).tolist(),
            "covariance": np.ravel(kf.P).tolist(),
            "residual": np.ravel(kf.y).tolist(),
            "innovation_covariance": np.ravel(kf.S).tolist(),
            "log_likelihood": float(kf.log_likelihood),
        }
    )


def linear(rng):
    """Constant velocity in the plane: x, y, their velocities; x and y measured, their noises correlated."""
    dt = 0.5
    f = np.eye(4) + np.diag([dt, dt], 2)
    block = np.array([[dt**3 / 3, dt**2 / 2], [dt**2 / 2, dt]]) * 0.7
    q = np.kron(block, np.eye(2))
    h = np.eye(2, 4)
    r = np.array([[0.4, 0.1], [0.1, 0.2]])
    kf = KalmanFilter(dim_x=4, dim_z=2)
    kf.x, kf.P, kf.F, kf.Q, kf.H, kf.R = np.zeros((4, 1)), np.diag([4.0, 4, 9, 9]), f, q, h, r
    case = {"f": f, "q": q, "h": h, "r": r, "p0": kf.P.copy(), "x0": [0.0] * 4}
    zs, steps = [], []
    for k in range(STEPS):
        z = np.array([3 * k * dt, np.sin(k * dt)]) + rng.normal(size=2)
        kf.predict()
        kf.update(z.reshape(2, 1))
        zs.append(z.tolist())
        record(steps, kf)
    return {key: np.ravel(value).tolist() for key, value in case.items()} | {"z": zs, "steps": steps}


DT, MU = 0.05, 1.5
VDP_Q = np.array([[1e-3, 2e-4], [2e-4, 4e-3]])
VDP_R = np.array([[0.04]])
VDP_X0, VDP_P0 = np.array([2.0, 0.0]), np.array([[0.3, 0.1], [0.1, 0.5]])


def vdp(x, dt=DT):
    """An Euler step of the Van der Pol oscillator."""
    return np.array([x[0] + dt * x[1], x[1] + dt * (MU * (1 - x[0] ** 2) * x[1] - x[0])])


def vdp_jacobian(x):
    return np.array([[1, DT], [DT * (-2 * MU * x[0] * x[1] - 1), 1 + DT * MU * (1 - x[0] ** 2)]])


def seen(x):
    """A measurement that is not linear either."""
    return np.array([x[0] + 0.1 * x[1] ** 2])


def seen_jacobian(x):
    return np.array([[1.0, 0.2 * x[1]]])


def measurements(rng):
    x, zs = VDP_X0.copy(), []
    for _ in range(STEPS):
        x = vdp(x)
        zs.append(float(seen(x)[0] + 0.2 * rng.normal()))
    return zs


def extended(zs):
    kf = ExtendedKalmanFilter(dim_x=2, dim_z=1)
    kf.x, kf.P, kf.Q, kf.R = VDP_X0.copy(), VDP_P0.copy(), VDP_Q, VDP_R
    steps = []
    for z in zs:
        kf.F = vdp_jacobian(kf.x)
        x = vdp(kf.x)
        kf.predict()
        kf.x = x  # filterpy predicts F x; the filter is f(x)
        kf.update(np.array([z]), seen_jacobian, seen)
        record(steps, kf)
    return steps


def unscented(zs, points, reused):
    kf = UnscentedKalmanFilter(dim_x=2, dim_z=1, dt=DT, fx=vdp, hx=seen, points=points)
    kf.x, kf.P, kf.Q, kf.R = VDP_X0.copy(), VDP_P0.copy(), VDP_Q, VDP_R
    steps = []
    for z in zs:
        before = points.sigma_points(kf.x, kf.P)
        kf.predict()
        if reused:
            kf.sigmas_f = np.array([vdp(point) for point in before])
        else:
            kf.sigmas_f = points.sigma_points(kf.x, kf.P)
        kf.update(np.array([z]))
        record(steps, kf)
    return steps


def main():
    rng = np.random.default_rng(20)
    data = {"linear": linear(rng)}
    zs = measurements(rng)
    julier, merwe = JulierSigmaPoints(2, 1.0), MerweScaledSigmaPoints(2, 0.6, 2.0, 0.0)
    data["van_der_pol"] = {
        "dt": DT,
        "mu": MU,
        "q": np.ravel(VDP_Q).tolist(),
        "r": VDP_R[0, 0],
        "x0": VDP_X0.tolist(),
        "p0": np.ravel(VDP_P0).tolist(),
        "z": zs,
        "extended": extended(zs),
        "symmetric_redrawn": unscented(zs, julier, False),
        "symmetric_reused": unscented(zs, julier, True),
        "scaled_redrawn": unscented(zs, merwe, False),
        "scaled_reused": unscented(zs, merwe, True),
    }
    OUT.parent.mkdir(exist_ok=True)
    partial = OUT.with_suffix(".json.partial")
    partial.write_text(json.dumps(data, separators=(",", ":")) + "\n")
    partial.rename(OUT)
    print(f"{OUT}: {OUT.stat().st_size} bytes")


if __name__ == "__main__":
    main()
