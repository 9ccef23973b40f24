"""A study of a second, for the tests of what is done with results."""

STUDY = {
    "report.title": "drawn <b>logs</b>",
    "dataset": {"type": "simulated_log"},
    "estimators": [{"type": "ekf"}, {"type": "trajectory_iekf", "max_iterations": 3}],
    "trials": 2,
    "sweep": [
        {"key": "dataset.odometry.sigma_theta_rad", "name": "noise", "values": [0.01, 0.02]},
        {"key": "dataset.loops.sigma_x_m", "name": "loops", "values": [0.01, 0.1, 1]},
    ],
}

# The ekf fails its first trial, and has a path and figures of it.
FAILING = {
    "dataset": {
        "type": "simulated_log",
        "mission": {"type": "sweep", "legs": 6, "leg_length_m": 20, "leg_spacing_m": 1.4},
        "odometry": {"sigma_x_m": 0.01, "sigma_y_m": 0.01, "sigma_theta_rad": 0.25},
        "loops": {"max_per_keyframe": 2},
    },
    "estimators": [{"type": "trajectory_iekf", "max_iterations": 3}, {"type": "ekf"}],
    "trials": 3,
}
