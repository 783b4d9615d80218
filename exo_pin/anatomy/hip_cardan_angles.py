"""Cardan angles of the hip: conversion between rotation orders, and from a rotation matrix."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from exo_pin.anatomy.names import HIP_ORDERS, SIDES, HipOrder, Side
from exo_pin.arrays import Array
from exo_pin.errors import UnknownNameError


def reorder(angles: npt.ArrayLike, side: Side, *, source: HipOrder, target: HipOrder) -> Array:
    """Hip angles of the order `source` as those of the order `target` that make the same rotation.

    Args:
        angles: Flexion, adduction, internal rotation (..., 3) [rad], always in this order of columns.
        side: `"left"` or `"right"`.
        source: `"clinical"` (flexion, adduction, rotation from the pelvis outwards) or `"yaw_roll_pitch"`.
        target: The order that is wanted.

    Returns:
        Flexion, adduction, internal rotation (..., 3) [rad]; adduction within +-90 degrees.

    Raises:
        UnknownNameError: A side or an order is unknown.
    """
    for order in (source, target):
        if order not in HIP_ORDERS:
            raise UnknownNameError("hip order", order, HIP_ORDERS)
    angles = np.asarray(angles, dtype=float)
    if source == target:
        return angles.copy()
    signs = _signs(side)
    a, b, c = np.moveaxis(angles * signs, -1, 0)
    if source == "clinical":
        return np.stack(_zxy_of_yxz(a, b, c), axis=-1) * signs
    return np.stack(_yxz_of_zxy(a, b, c), axis=-1) * signs


def hip_angles(R: npt.ArrayLike, side: Side) -> Array:
    """Clinical hip angles of a thigh's rotation.

    Args:
        R: Rotation of the thigh seen from the pelvis (..., 3, 3).
        side: `"left"` or `"right"`.

    Returns:
        Flexion, adduction, internal rotation (..., 3) [rad]; adduction within +-90 degrees.

    Raises:
        UnknownNameError: The side is unknown.
    """
    R = np.asarray(R, dtype=float)
    b = np.arctan2(-R[..., 1, 2], np.hypot(R[..., 1, 0], R[..., 1, 1]))
    yxz = np.arctan2(R[..., 0, 2], R[..., 2, 2]), b, np.arctan2(R[..., 1, 0], R[..., 1, 1])
    return np.stack(yxz, axis=-1) * _signs(side)


def _signs(side: Side) -> Array:
    """Flexion turns about -y; adduction and rotation about +x and +z on the right, -x and -z on the left."""
    if side not in SIDES:
        raise UnknownNameError("side", side, SIDES)
    s = -1.0 if side == "left" else 1.0
    return np.array([-1.0, s, s])


def _zxy_of_yxz(a: Array, b: Array, c: Array) -> tuple[Array, Array, Array]:
    """Angles (about y, x, z) of R = Rz Rx Ry, for R = Ry(a) Rx(b) Rz(c)."""
    sa, ca, sb, cb, sc, cc = np.sin(a), np.cos(a), np.sin(b), np.cos(b), np.sin(c), np.cos(c)
    r01, r11 = sa * sb * cc - ca * sc, cb * cc
    r20, r21, r22 = ca * sb * sc - sa * cc, ca * sb * cc + sa * sc, ca * cb
    return np.arctan2(-r20, r22), np.arctan2(r21, np.hypot(r20, r22)), np.arctan2(-r01, r11)


def _yxz_of_zxy(a: Array, b: Array, c: Array) -> tuple[Array, Array, Array]:
    """Angles (about y, x, z) of R = Ry Rx Rz, for R = Rz(c) Rx(b) Ry(a)."""
    sa, ca, sb, cb, sc, cc = np.sin(a), np.cos(a), np.sin(b), np.cos(b), np.sin(c), np.cos(c)
    r02, r22 = cc * sa + sc * sb * ca, cb * ca
    r10, r11, r12 = sc * ca + cc * sb * sa, cc * cb, sc * sa - cc * sb * ca
    return np.arctan2(r02, r22), np.arctan2(-r12, np.hypot(r10, r11)), np.arctan2(r10, r11)
