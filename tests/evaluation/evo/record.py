#!/usr/bin/env python3
"""Records what evo (github.com/MichaelGrupp/evo) says of trajectories, as figures.csv.

    python3 record.py TRAJECTORIES EVO_VERSION [DATA] > figures.csv

TRAJECTORIES: a folder that trajectories.py filled. DATA: the folder with pose_graphs/ and copr/.
evo_ape, evo_rpe and evo_traj must be on the PATH. Each line of the output is a command, run where
its trajectories lie, and the statistics of its --save_results.
"""
import json
import math
import os
import shutil
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

FIGURES = ('rmse', 'mean', 'median', 'std', 'min', 'max', 'sse')

# Case: pair, plane, alignment, what. The test computes the same by the words of the case.
FLAT = 'tum flat_reference.tum flat_estimate.tum'
SPACE = 'euroc space_reference.csv space_estimate.tum'
# On their plane before they are aligned: evo's own --project_to_plane comes after the alignment.
LEVEL = 'tum level/space_reference.tum level/space_estimate.tum'
KITTI = 'kitti kitti_reference.txt kitti_estimate.txt'
LEVEL_KITTI = 'kitti level/kitti_reference.kitti level/kitti_estimate.kitti'
CASES = [
    ('flat none position', f'evo_ape {FLAT}'),
    ('flat none heading', f'evo_ape {FLAT} -r angle_rad'),
    ('flat origin position', f'evo_ape {FLAT} --align_origin'),
    ('flat origin heading', f'evo_ape {FLAT} --align_origin -r angle_rad'),
    ('flat se2 position', f'evo_ape {FLAT} -a'),
    ('flat se2 heading', f'evo_ape {FLAT} -a -r angle_rad'),
    ('flat step-1 position', f'evo_rpe {FLAT} --delta 1 --delta_unit f'),
    ('flat step-1 heading', f'evo_rpe {FLAT} --delta 1 --delta_unit f -r angle_rad'),
    ('flat step-5 position', f'evo_rpe {FLAT} --delta 5 --delta_unit f --all_pairs'),
    ('flat step-5 heading', f'evo_rpe {FLAT} --delta 5 --delta_unit f --all_pairs -r angle_rad'),
    ('space none position-and-height', f'evo_ape {SPACE}'),
    ('space none position', f'evo_ape {SPACE} --project_to_plane xy'),
    ('space none heading', f'evo_ape {SPACE} --project_to_plane xy -r angle_rad'),
    ('space step-1 position', f'evo_rpe {SPACE} --delta 1 --delta_unit f --project_to_plane xy'),
    ('space origin position', f'evo_ape {LEVEL} --align_origin'),
    ('space origin heading', f'evo_ape {LEVEL} --align_origin -r angle_rad'),
    ('space se2 position', f'evo_ape {LEVEL} -a'),
    ('space yaw position', f'evo_ape {LEVEL} -a'),
    ('space yaw heading', f'evo_ape {LEVEL} -a -r angle_rad'),
    ('kitti none position-and-height', f'evo_ape {KITTI}'),
    ('kitti none position', f'evo_ape {KITTI} --project_to_plane xz'),
    ('kitti se2 position', f'evo_ape {LEVEL_KITTI} -a'),
]
COPR = 'euroc copr/mav0/state_groundtruth_estimate0/data.csv odometry.tum'
M3500 = 'tum pose_graphs/M3500.groundtruth.tum M3500.tum'
DATA_CASES = [
    ('copr none position', f'evo_ape {COPR} --project_to_plane xy'),
    ('copr origin position', f'evo_ape {COPR} --align_origin --project_to_plane xy'),
    ('copr step-1 position', f'evo_rpe {COPR} --delta 1 --delta_unit f --project_to_plane xy'),
    ('M3500 none position', f'evo_ape {M3500}'),
    ('M3500 origin heading', f'evo_ape {M3500} --align_origin -r angle_rad'),
    ('M3500 se2 position', f'evo_ape {M3500} -a'),
    ('M3500 step-10 position', f'evo_rpe {M3500} --delta 10 --delta_unit f --all_pairs'),
]


def run(command, folder):
    subprocess.run(command.split(), cwd=folder, check=True, stdout=subprocess.DEVNULL)


def level(folder):
    (folder / 'level').mkdir()
    project = '--project_to_plane {} --save_as_{} --no_warnings'
    for kind, name in (('euroc', 'space_reference.csv'), ('tum', 'space_estimate.tum')):
        run(f'evo_traj {kind} ../{name} {project.format("xy", "tum")}', folder / 'level')
    for name in ('kitti_reference.txt', 'kitti_estimate.txt'):
        run(f'evo_traj kitti ../{name} {project.format("xz", "kitti")}', folder / 'level')


def line_of_tum(t, x, y, theta):
    return f'{t} {x!r} {y!r} 0 0 0 {math.sin(theta / 2)!r} {math.cos(theta / 2)!r}\n'


def odometry_of_copr(folder):
    text = ''
    for line in (folder / 'copr/mav0/odometry0/data.csv').read_text().splitlines():
        if line.startswith('#'):
            continue
        t, x, y, theta = line.split(',')[:4]
        text += line_of_tum(f'{int(t) // 10**9}.{int(t) % 10**9:09d}', *map(float, (x, y, theta)))
    (folder / 'odometry.tum').write_text(text)


def dead_reckoning_of_m3500(folder):
    steps = {}
    for line in (folder / 'pose_graphs/M3500.g2o').read_text().splitlines():
        words = line.split()
        if words and words[0] == 'EDGE_SE2' and int(words[2]) == int(words[1]) + 1:
            steps.setdefault(int(words[2]), tuple(map(float, words[3:6])))
    x = y = theta = 0.0
    text = line_of_tum(0, x, y, theta)
    for k in sorted(steps):
        dx, dy, dtheta = steps[k]
        c, s = math.cos(theta), math.sin(theta)
        x, y, theta = x + c * dx - s * dy, y + s * dx + c * dy, theta + dtheta
        text += line_of_tum(k, x, y, theta)
    (folder / 'M3500.tum').write_text(text)


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        shutil.copytree(sys.argv[1], folder, dirs_exist_ok=True)
        level(folder)
        cases = list(CASES)
        if len(sys.argv) > 3:
            for part in ('copr', 'pose_graphs'):
                os.symlink(Path(sys.argv[3]).resolve() / part, folder / part)
            odometry_of_copr(folder)
            dead_reckoning_of_m3500(folder)
            cases += DATA_CASES
        print(f'# made by record.py with evo {sys.argv[2]}')
        print('case,' + ','.join(FIGURES) + ',command')
        for case, command in cases:
            run(f'{command} --save_results r.zip --no_warnings', folder)
            with zipfile.ZipFile(folder / 'r.zip') as archive:
                stats = json.loads(archive.read('stats.json'))
            figures = [repr(float(stats[f])) for f in FIGURES]
            print(','.join([case] + figures + [command]), flush=True)


if __name__ == '__main__':
    main()
