"""Claims of docs/cost.md."""

from claims import claim, numbers_of

PAGE = "docs/cost.md"
GRAPHS = ("ring", "CSAIL", "MIT", "intel", "manhattan", "M3500", "M3500a", "M3500b", "M3500c")
BAD_START = ("MIT", "M3500a", "M3500b", "M3500c")


def over_the_least(cell):
    """F over the least one by "31.2 (`iteration_limit`, F × 84)"; 1 where a cell has none."""
    _, has_f, said = cell.partition("F ")
    if not has_f:
        return 1.0
    number = numbers_of(said)[0]
    return 1 + number / 100 if "%" in said else number


@claim(PAGE, "`sparse_gauss_newton` alone ends at the least F on all; `g2o/linear` does on MIT and "
       "M3500a")
def one_ends_at_the_least_in_batch(t):
    rows = t("cost-all-batch")

    def at_the_least(row, graphs):
        return [graph for graph in graphs if over_the_least(row[graph]) <= 1]

    from_bad = {row["batch, ms"]: at_the_least(row, BAD_START) for row in rows}
    ours = [row for row in rows if row["batch, ms"] == "sparse_gauss_newton"]
    return ([at_the_least(row, GRAPHS) for row in ours] == [list(GRAPHS)]
            and {name: graphs for name, graphs in from_bad.items() if graphs}
            == {"sparse_gauss_newton": list(BAD_START), "g2o/linear": ["MIT", "M3500a"]})


@claim(PAGE, "end at the least F on all nine")
def three_end_at_the_least_keyframe_by_keyframe(t):
    def ends(graph):
        least = min(row.number("chi2") for row in t(f"cost-{graph.lower()}"))
        rows = [row for row in t(f"cost-{graph.lower()}", 1)
                if row["incremental"] in ("ceres_pose_graph", "g2o", "sparse_gauss_newton")]
        return len(rows) == 3 and all(row.number("chi2") <= 1.000001 * least for row in rows)

    return all(map(ends, GRAPHS))
