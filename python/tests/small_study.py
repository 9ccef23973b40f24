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
