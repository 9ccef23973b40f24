#!/usr/bin/env python3
"""Draws the pairs of trajectories of this folder; seeded, so that they come out the same.

    python3 trajectories.py FOLDER

A survey in five legs. flat_*.tum lie on the plane; space_* heave, roll and pitch; kitti_* have a
camera's axes (x right, y down, z forward). Estimates are rarer than references, late by some
milliseconds, drift, and begin elsewhere.
"""
import math
import random
import sys
from pathlib import Path

START_S = 1_700_000_000


def product(a, b):
    """Of two quaternions w x y z."""
    aw, ax, ay, az = a
    bw, bx, by, bz = b
    return (aw * bw - ax * bx - ay * by - az * bz, aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx, aw * bz + ax * by - ay * bx + az * bw)


def turn(axis, angle):
    q = [math.cos(angle / 2), 0.0, 0.0, 0.0]
    q[1 + axis] = math.sin(angle / 2)
    return tuple(q)


def attitude(yaw, pitch, roll):
    return product(product(turn(2, yaw), turn(1, pitch)), turn(0, roll))


def on_the_way(t):
    """x, y, yaw after t seconds at 0.5 m/s: legs of 10 m, half circles of 1 m radius."""
    leg, arc = 10.0, math.pi
    n, s = divmod(0.5 * t, leg + arc)
    side = 1 if n % 2 == 0 else -1
    y = 2.0 * n
    if s <= leg:
        return (s if side > 0 else leg - s), y, 0.0 if side > 0 else math.pi
    a = s - leg
    return ((leg if side > 0 else 0.0) + side * math.sin(a), y + 1 - math.cos(a),
            a if side > 0 else math.pi - a)


def drawn(count, interval_s, late_s, drift, spatial, rng):
    """Rows (t, position, quaternion)."""
    rows = []
    dx = dy = dyaw = dz = 0.0
    for k in range(count):
        t = 1.0 + k * interval_s + (rng.uniform(-late_s, late_s) if late_s else 0.0)
        x, y, yaw = on_the_way(1.0 + k * interval_s)
        z = -8 + 0.15 * math.sin(0.2 * t) if spatial else 0.0
        pitch = 0.05 * math.sin(0.7 * t) if spatial else 0.0
        roll = 0.08 * math.sin(1.1 * t + 1) if spatial else 0.0
        if drift:
            dx, dy = dx + rng.gauss(0, 0.03), dy + rng.gauss(0, 0.03)
            dyaw, dz = dyaw + rng.gauss(0, 0.01), dz + rng.gauss(0, 0.02)
            c, s = math.cos(0.4), math.sin(0.4)
            x, y, yaw = (3 + c * (x + dx) - s * (y + dy), -2 + s * (x + dx) + c * (y + dy),
                         yaw + 0.4 + dyaw)
            if spatial:
                z += 1.5 + dz
                pitch, roll = pitch + rng.gauss(0, 0.01), roll + rng.gauss(0, 0.01)
        rows.append((t, (x, y, z), attitude(yaw, pitch, roll)))
    return rows


def camera(rows):
    """Forward, left, up to right, down, forward, of the world and of the body."""
    return [(t, (-p[1], -p[2], p[0]), (q[0], -q[2], -q[3], q[1])) for t, p, q in rows]


def seconds(t):
    return f'{START_S + int(t)}.{int(round((t - int(t)) * 1e9)):09d}'


def tum(rows):
    return ''.join(f'{seconds(t)} {p[0]:.9f} {p[1]:.9f} {p[2]:.9f} '
                   f'{q[1]:.12f} {q[2]:.12f} {q[3]:.12f} {q[0]:.12f}\n' for t, p, q in rows)


def euroc(rows):
    head = ('#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], '
            'q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z [], v_RS_R_x [m s^-1]\n')
    return head + ''.join(f'{seconds(t).replace(".", "")},{p[0]:.9f},{p[1]:.9f},{p[2]:.9f},'
                          f'{q[0]:.12f},{q[1]:.12f},{q[2]:.12f},{q[3]:.12f},0.5\n'
                          for t, p, q in rows)


def kitti(rows):
    text = ''
    for _, p, (w, x, y, z) in rows:
        r = ((1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
             (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
             (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)))
        text += ' '.join(f'{v:.12f}' for i in range(3) for v in (*r[i], p[i])) + '\n'
    return text


def main():
    folder = Path(sys.argv[1])
    rng = random.Random(14)
    files = {
        'flat_reference.tum': tum(drawn(120, 1.0, 0, False, False, rng)),
        'flat_estimate.tum': tum(drawn(58, 2.0, 0.004, True, False, rng)),
        'space_reference.csv': euroc(drawn(120, 1.0, 0, False, True, rng)),
        'space_estimate.tum': tum(drawn(58, 2.0, 0.004, True, True, rng)),
        'kitti_reference.txt': kitti(camera(drawn(58, 2.0, 0, False, True, rng))),
        'kitti_estimate.txt': kitti(camera(drawn(58, 2.0, 0, True, True, rng))),
    }
    for name, text in files.items():
        (folder / name).write_text(text)


if __name__ == '__main__':
    main()
