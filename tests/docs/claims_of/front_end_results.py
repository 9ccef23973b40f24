"""Claims of docs/front_end_results.md."""

from claims import claim

PAGE = "docs/front_end_results.md"


@claim(PAGE, "On every half the NIS of translation is 0.3 to 0.7 where 2 is expected, and no "
       "interval reaches 2. Headings have 1.3 to 1.6 where 1 is expected, and every interval "
       "contains 1")
def shipped_covariances_are_wide_in_translation(t):
    rows = [row for row in t("real-covariance-judged")
            if row["settings fitted on"] == "shipped" and not row["judged on"].startswith("all")]
    translation = [row.numbers("translation (2)") for row in rows]
    heading = [row.numbers("heading (1)") for row in rows]

    def span(values):
        return min(value for value, _, _ in values), max(value for value, _, _ in values)

    return (len(rows) == 4 and span(translation) == (0.3, 0.7) and span(heading) == (1.3, 1.6)
            and all(most < 2 for _, _, most in translation)
            and all(least <= 1 <= most for _, least, most in heading))
