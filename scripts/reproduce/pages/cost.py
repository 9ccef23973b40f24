"""docs/cost.md: the program `back_ends`, and what estimators/*.md show of it."""

from layout import NOTHING, fixed, significant, table
from maker import maker
from markdown import tables_of

GRAPHS = ("ring", "CSAIL", "MIT", "intel", "manhattan", "M3500", "M3500a", "M3500b", "M3500c")
HOW = "`build/release/back_ends GRAPH.g2o` with the plug-ins and variants of the table of settings"

# Solvers of others (docs/adapters.md): as they come, and with other settings. What is solved anew
# whenever loops arrive is run keyframe by keyframe as it comes alone.
PLUGINS = ("adapters/gtsam.so", "adapters/g2o.so", "adapters/mrpt.so")
SE_SYNC = "adapters/se_sync"
FINE = "relinearize_threshold=0.01 relinearize_skip=1"
EXACT = "exact_jacobians=true"
BATCH_VARIANTS = {
    "gtsam/gn": "gtsam method=gauss_newton",
    "gtsam/exact": f"gtsam {EXACT}",
    "gtsam/gn/exact": f"gtsam method=gauss_newton {EXACT}",
    "gtsam/dogleg/exact": f"gtsam method=dogleg {EXACT}",
    "gtsam/lago/gn/exact": f"gtsam method=gauss_newton start=lago {EXACT}",
    "g2o/lm": "g2o method=levenberg_marquardt",
    "g2o/dogleg": "g2o method=dogleg",
    "g2o/linear": "g2o method=slam2d_linear",
}
VARIANTS = {
    "gtsam_isam2/fine": f"gtsam_isam2 {FINE}",
    "gtsam_isam2/fine/exact": f"gtsam_isam2 {FINE} {EXACT}",
}


# The paper's filter, near convergence.
TEN = ("--variant", "trajectory_iekf=trajectory_iekf max_iterations=10")


def _of_others(work):
    """Arguments of back_ends for those that are built."""
    def built(path):
        return (work.build / path).exists()

    def variants(flag, all_variants):
        for label, words in all_variants.items():
            if built(f"adapters/{label.split('/')[0].split('_')[0]}.so"):
                yield from (flag, f"{label}={words}")

    arguments = []
    for plugin in filter(built, PLUGINS):
        arguments += ["--plugin", str((work.build / plugin).absolute())]
    arguments += [*variants("--variant", VARIANTS), *variants("--batch-variant", BATCH_VARIANTS)]
    if built(SE_SYNC):
        program = (work.build / SE_SYNC).absolute()
        arguments += ["--batch-variant",
                      f"se_sync=command 'command={program} {{input}} {{output}}'"]
    return arguments


def costs(work, graph):
    """Tables of a graph: batch, incremental."""
    effort = work.size(["--repeats", 3, "--budget", 30], ["--repeats", 1, "--budget", 5])
    return tables_of(work.output(f"back-ends-{graph}", "back_ends", work.graph(graph),
                                 *effort, *TEN, *_of_others(work)))


def batch_rows(work, graph):
    """Rows of the batch table by estimator: dicts by column."""
    header, rows = costs(work, graph)[0]
    return {row[0].strip("`"): dict(zip(header, row)) for row in rows}


def growth_folder(work):
    """Where `back_ends --growth` has left its tables, and growth.svg."""
    few = work.size([], ["--largest", 1000, "--budget", 5])
    return work.run("growth", "back_ends", "--growth", "{out}/growth.svg", *few)


def growth(work):
    """Tables of growth: batch by keyframes, incremental by keyframes, by loops."""
    return tables_of((growth_folder(work) / "stdout.txt").read_text("utf-8"))


def _graph(name):
    @maker("docs/cost.md", f"cost-{name.lower()}", "time", HOW, 5,
           needs=(f"pose_graphs/{name}.g2o",), programs=("back_ends", *PLUGINS, SE_SYNC))
    def graph_tables(work):
        return "\n".join(table(header, rows) for header, rows in costs(work, name))


for _name in GRAPHS:
    _graph(_name)


def _summary(number, head, time):
    """A row for each solver, a column for each graph: its time, and in brackets its gap where that
    is above a millionth of F, or its outcome where that is no convergence."""
    def cell(row, optimum):
        if row["outcome"] == "gave up":
            return NOTHING
        words = [] if row["outcome"] == "converged" else [f"`{row['outcome']}`"]
        share = float(row["chi2"]) / optimum - 1
        if not share < 1e-6:
            words.append(f"F +{significant(100 * share, 2)} %" if share < 1
                         else f"F × {significant(1 + share, 2)}" if share < 1e4
                         else f"F × {share:.0e}")
        return row[time] + (f" ({', '.join(words)})" if words else "")

    def summary(work):
        columns = []
        for graph in GRAPHS:
            tables = costs(work, graph)
            optimum = min(float(row[tables[0][0].index("chi2")]) for row in tables[0][1]
                          if row[1] in ("converged", "iteration_limit"))
            header, rows = tables[number]
            columns.append({row[0]: cell(dict(zip(header, row)), optimum) for row in rows})
        return table([head, *GRAPHS], [[name, *(column[name] for column in columns)]
                                       for name in columns[0]])
    return summary


for _number, _name, _time in ((0, "batch", "ms"), (1, "incremental", "total, ms")):
    maker("docs/cost.md", f"cost-all-{_name}", "time", HOW, 45,
          needs=tuple(f"pose_graphs/{g}.g2o" for g in GRAPHS),
          programs=("back_ends", *PLUGINS, SE_SYNC))(
              _summary(_number, f"{_name}, ms", _time))

GROWTH = dict(kind="time", how="`build/release/back_ends --growth FILE.svg`", minutes=30,
              programs=("back_ends",))


@maker("docs/cost.md", "cost-growth", pictures=("docs/images/growth.svg",), **GROWTH)
def growth_tables(work):
    work.picture("docs/images/growth.svg", growth_folder(work) / "growth.svg")
    return "\n".join(table(header, rows) for header, rows in growth(work)[1:])


@maker("docs/cost.md", "cost-maps", "time", "`build/release/back_ends --maps FILE.svg`", 40,
       programs=("back_ends",), pictures=("docs/images/maps.svg",))
def large_maps(work):
    few = work.size([], ["--keyframes", "1000,3000"])
    folder = work.run("maps", "back_ends", "--maps", "{out}/maps.svg", *few)
    work.picture("docs/images/maps.svg", folder / "maps.svg")
    parts = []
    for header, rows in tables_of((folder / "stdout.txt").read_text("utf-8")):
        one, two = (next(i for i, text in enumerate(header) if text.endswith(ending))
                    for ending in ("`sparse_gauss_newton`, s", "2 threads, s"))
        parts.append(table([*header[:two + 1], "gain", *header[two + 1:]],
                           [[*row[:two + 1], _gain(row[one], row[two]), *row[two + 1:]]
                            for row in rows]))
    return "\n".join(parts)


def _gain(one, two):
    return NOTHING if NOTHING in (one, two) else fixed(float(one) / float(two), 2)


@maker("docs/cost.md", "cost-smoother-update", **GROWTH)
def smoother_update(work):
    header, rows = growth(work)[1]
    totals = next(row for row in rows if row[0] == "`incremental_smoother`")
    columns = [i for i, text in enumerate(header) if text.isdigit() and 1000 <= int(text) <= 10000]
    shown = [NOTHING if totals[i] == NOTHING
             else significant(float(totals[i]) / (int(header[i]) / 3), 2) for i in columns]
    return table(["keyframes", *(header[i] for i in columns)], [["ms an update", *shown]])


@maker("docs/estimators/sparse_gauss_newton.md", "sgn-graphs", "time",
       "`build/release/back_ends GRAPH.g2o`", 20, programs=("back_ends",),
       needs=tuple(f"pose_graphs/{g}.g2o" for g in GRAPHS))
def sgn_graphs(work):
    rows = []
    for graph in GRAPHS:
        by_name = batch_rows(work, graph)
        own, ceres = by_name["sparse_gauss_newton"], by_name["ceres_pose_graph"]
        same_f = abs(float(ceres["chi2"]) / float(own["chi2"]) - 1) < 1e-6
        rows.append([graph, fixed(float(own["chi2"]), 4), own["linearisations"], own["ms"],
                     ceres["ms"] if same_f else f"ends at {ceres['chi2']}",
                     own["covariances, ms"]])
    return table(["graph", "F", "linearisations", "ours", "Ceres", "all covariances"], rows)


@maker("docs/estimators/sparse_gauss_newton.md", "sgn-growth", **GROWTH)
def sgn_growth(work):
    header, rows = growth(work)[0]
    by_name = {row[0].strip("`"): row for row in rows}
    return table(["keyframes", "ours", "Ceres"],
                 [[header[i], by_name["sparse_gauss_newton"][i], by_name["ceres_pose_graph"][i]]
                  for i in range(1, len(header))])
