"""What docs/shared_errors_results.md says of its tables."""

from claims import claim

PAGE = "docs/shared_errors_results.md"


@claim(PAGE, "**Registrations are as good as they say** in all rows: NIS 2.7 to 3.2")
def measured_attitudes_are_honest(t):
    found = [row.number("NIS against truth") for row in t("attitude")]
    return round(min(found), 1) == 2.7 and round(max(found), 1) == 3.2
