"""docs/cost.md: stages of a batch solve, and what errors of pictures cost."""

from layout import significant, table
from maker import maker
from pages.performance import row_of

SHAPES = ("chain", "drive", "short_drive", "office", "circuit", "survey", "streets")
STAGES = ("hand over", "chains", "expand", "analysis", "memory", "headings", "linearise",
          "factorise", "substitute", "move", "check")


@maker("docs/cost.md", "cost-stages", "time",
       "`build/release/batch_benchmark --benchmark_filter=stages`, medians of 30", 1,
       programs=("batch_benchmark",))
def cost_stages(work):
    shapes = work.size(SHAPES, SHAPES[2:3])
    rows = work.benchmark("batch-stages", "batch_benchmark",
                          f"--benchmark_filter=stages/({'|'.join(shapes)})/",
                          f"--benchmark_repetitions={work.size(30, 3)}",
                          "--benchmark_min_time=0.05", "--benchmark_report_aggregates_only=true")
    cells = []
    for shape in shapes:
        row = row_of(rows, f"stages/{shape}/manual_time_median")
        cells.append([shape.replace("_", " "), f"{row['keyframes']:.0f}", f"{row['loops']:.0f}",
                      f"{row['linearisations']:.0f}", significant(row["real_time"]),
                      *(significant(row[stage]) if stage in row else "–" for stage in STAGES),
                      significant(row["dense"]), significant(row["clear"])])
    return table(["graph", "keyframes", "loops", "linearisations", "whole",
                  *("LAGO" if stage == "headings" else stage for stage in STAGES),
                  "bound: factorise", "bound: substitute"], cells)


SHARED = (("batch", "sparse_gauss_newton"), ("batch", "ceres_pose_graph"),
          ("incremental", "sparse_gauss_newton"), ("incremental", "incremental_smoother"))
SHARED_GRAPHS = ("intel", "manhattan", "M3500")


@maker("docs/cost.md", "cost-shared", "time",
       "`FATHOM_POSE_GRAPHS=FOLDER build/release/shared_errors_benchmark`, medians of five", 10,
       needs=tuple(f"pose_graphs/{graph}.g2o" for graph in ("ring", *SHARED_GRAPHS)),
       programs=("shared_errors_benchmark",))
def cost_shared(work):
    graphs = work.size(SHARED_GRAPHS, ("ring",))
    rows = work.benchmark("shared-errors", "shared_errors_benchmark",
                          f"--benchmark_filter=/({'|'.join(graphs)})/",
                          "--benchmark_repetitions=5", "--benchmark_min_time=0.01",
                          env={"FATHOM_POSE_GRAPHS": str(work.data / "pose_graphs")})
    cells = []
    for graph in graphs:
        for mode, estimator in SHARED:
            independent, states = (
                row_of(rows, f"{mode}/{graph}/{estimator}/{model}/manual_time_median")["real_time"]
                for model in ("independent", "states"))
            cells.append([graph, mode, f"`{estimator}`", significant(independent),
                          significant(states), significant(states / independent, 2)])
    return table(["graph", "", "estimator", "independent", "states", "ratio"], cells)
