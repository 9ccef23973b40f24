"""Claims of docs/paper.md."""

from claims import claim

PAGE = "docs/paper.md"
ESTIMATORS = ("trajectory_iekf", "iekf_1", "ekf", "ceres_pose_graph")


def groups(rows, *columns):
    """The rows by what these columns say."""
    found = {}
    for row in rows:
        found.setdefault(tuple(row[column] for column in columns), []).append(row)
    return found


def spread(rows, column):
    values = [row.number(column) for row in rows]
    return max(values) - min(values)


@claim(PAGE, "finds every pair that is tried, the paper's 98 to 99 %, and all that either finds "
       "overlap (precision 1.00)")
def every_pair_is_found(t):
    def finds(row):
        share = row.number("loops") / row.number("pairs tried")
        return share == 1 if row["registration"] == "Fathom's" else 98 <= round(100 * share) <= 99

    return all(finds(row) and row.number("precision") == 1 for row in t("paper-registration-loops"))


@claim(PAGE, "At 2.2 m all consecutive keyframes register, as in the paper, and the error is 15 to "
       "17 mm, a fourteenth to a fifteenth of dead reckoning's")
def neighbours_of_separation_90_register(t):
    rows = [row for row in t("paper-registration-pool")
            if row.number("separation") == 90 and row.number("altitude") == 2.2]
    errors = [row.number(name) for row in rows for name in ("trajectory_iekf (mm)", "ekf (mm)")]
    shares = [round(1000 * row.number("dead reckoning (m)") / row.number("trajectory_iekf (mm)"))
              for row in rows]
    return (len(rows) == 4 and all(row.number("neighbours registered") == 100 for row in rows)
            and (min(errors), max(errors)) == (15, 17) and (min(shares), max(shares)) == (14, 15))


@claim(PAGE, "the intervals of their errors overlap in every pair of rows")
def errors_of_both_registrations_overlap(t):
    def overlap(rows, column):
        (_, least, most), (_, other_least, other_most) = (row.numbers(column) for row in rows)
        return least <= other_most and other_least <= most

    pairs = groups(t("paper-registration-pool"), "mission", "altitude", "separation").values()
    return all(overlap(rows, column) for rows in pairs
               for column in ("trajectory_iekf (mm)", "ekf (mm)"))


@claim(PAGE, "No estimator is better than another here.** The innovations are small: the errors of "
       "the first table agree in all digits shown. ANEES differs by at most 0.01 (3.66 and 3.67, "
       "1.50 and 1.51 at level 5), the share inside 2σ by at most 0.001, F above its minimum by "
       "orders of magnitude, with means below 0.04")
def estimators_of_the_sweep_are_alike(t):
    def agree(row):
        return len({row[f"{name} (mm)"] for name in ESTIMATORS}) == 1

    def are_alike(rows):
        excess = [row.number("F above the optimum") for row in rows]
        return (spread(rows, "ANEES") < 0.0101 and spread(rows, "inside 2σ") < 0.00101
                and 100 * min(excess) <= max(excess) < 0.04)

    found = groups(t("paper-consistency"), "separation", "level")
    at_level_5 = [{row.number("ANEES") for row in rows} for (_, level), rows in found.items()
                  if level == "5"]
    return (all(map(agree, t("paper-sweep"))) and all(map(are_alike, found.values()))
            and at_level_5 == [{3.66, 3.67}, {1.50, 1.51}])


@claim(PAGE, "All three end within 0.1 m of the reference, dead reckoning 2.6 m and more away")
def estimates_end_near_the_reference(t):
    rows = t("paper-real")
    errors = [row.number(name) for row in rows
              for name in ("trajectory_iekf", "ekf", "ceres_pose_graph")]
    return (0.085 < max(errors) < 0.0995
            and round(min(row.number("dead reckoning") for row in rows), 1) == 2.6)
