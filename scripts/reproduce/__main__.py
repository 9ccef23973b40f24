"""Makes the tables and figures of the docs: see scripts/reproduce.sh."""

import argparse
import os
import sys
from pathlib import Path

import audit
import markdown
import provenance
from comparison import differences
from maker import all_makers
from workshop import CommandFailed, Workshop

TOP = Path(__file__).resolve().parents[2]
DONE, STALE, BAD_USAGE, SKIPPED, STOPPED = 0, 1, 2, 77, 130


def parsed(arguments):
    parser = argparse.ArgumentParser(
        prog="reproduce.sh", description="Makes every table and figure of the docs, or of PAGE, "
        "from shipped configurations, and writes them between their markers.")
    add = parser.add_argument
    add("pages", nargs="*", metavar="PAGE",
        help="cost.md, estimators/ekf.md, README.md; default: all")
    add("--only", action="append", default=[], metavar="NAME", help="the maker of this name alone")
    add("--quick", action="store_true", help="only what takes seconds")
    add("--list", action="store_true", help="list the makers, and how old their figures are")
    add("--check", action="store_true",
        help="compare the quick ones with the pages, write nothing; status 1 where one is stale")
    add("--audit", action="store_true", help="check that every table of numbers has a maker")
    add("--print", action="store_true", help="print in place of writing")
    add("--small", action="store_true",
        help="the least that shows that a maker works (one trial of a study); prints")
    add("--again", action="store_true", help="run again what is in the scratch folder")
    add("--with-data", choices=("yes", "no"), help="only makers that need the data, or do not")
    add("--jobs", type=int, default=1, help="trials of a study at a time; default: 1")
    add("--out", default="build/reproduce", help="scratch folder; default: build/reproduce")
    add("--build", default="build/release", help="folder of the programs; default: build/release")
    add("--data", default=os.environ.get("FATHOM_DATA", "../shared/data"),
        help="folder with pose_graphs/, copr/ and worlds/; default: $FATHOM_DATA or ../shared/data")
    return parser.parse_args(arguments)


def fail(what):
    print(f"reproduce: error: {what}", file=sys.stderr)
    raise SystemExit(BAD_USAGE)


def page_named(name):
    """README.md; cost, cost.md, docs/cost.md; ekf, estimators/ekf.md."""
    pages = {one.page for one in all_makers()}
    name = name if name.endswith(".md") else name + ".md"
    found = [page for page in pages if page == name or page.endswith("/" + name)]
    if len(found) != 1:
        fail(f"no page '{name}' has a maker; --list names those that have")
    return found[0]


def chosen(options):
    makers = all_makers()
    wanted = {page_named(name) for name in options.pages}
    for name in options.only:
        if name not in {one.name for one in makers}:
            fail(f"no maker '{name}'; --list has them all")
    found = [one for one in makers
             if (not wanted or one.page in wanted)
             and (not options.only or one.name in options.only)
             and (not (options.quick or options.check) or one.kind == "quick")
             and (options.with_data is None or bool(one.needs) == (options.with_data == "yes"))]
    if not found:
        fail("no maker is left; --list has them all")
    return found


def lacks(one, options):
    """Why a maker cannot run here, or nothing."""
    for need in one.needs:
        if not (Path(options.data) / need).exists():
            return f"{Path(options.data) / need} is not there"
    for program in one.programs:
        if not (Path(options.build) / program).exists():
            return f"{Path(options.build) / program} is not built"
    return ""


def part_of(page, one):
    if one.name not in page.parts:
        raise markdown.PageError(f"{one.page}: no markers for the maker '{one.name}'")
    first, last = page.parts[one.name]
    return page.lines[first:last]


def list_makers(makers, options):
    form = "{:<34} {:<20} {:<6} {:>7}  {}"
    print(form.format("page", "maker", "kind", "minutes", "figures of"))
    newest = provenance.commit(TOP)
    for one in makers:
        state = provenance.state(part_of(markdown.read_page(TOP / one.page), one))
        if ", " in state and not state.startswith(newest + ", "):
            state += ", older than the sources"
        missing = lacks(one, options)
        print(form.format(one.page.removeprefix("docs/"), one.name, one.kind, f"{one.minutes:g}",
                          state + (f" ({missing})" if missing else "")))


def replace_file(path, content):
    """Whole or not at all."""
    beside = path.with_name(path.name + ".new")
    beside.write_bytes(content)
    os.replace(beside, path)


def line_of(one, workshop):
    return provenance.made_line(one.how, workshop.records, one.kind == "time")


def write(one, content, workshop):
    page = markdown.read_page(TOP / one.page)
    part_of(page, one)
    line = line_of(one, workshop)
    text = markdown.replace_part(page, one.name, f"{content.rstrip()}\n\n{line}")
    for target, source in workshop.pictures.items():
        replace_file(TOP / target, source.read_bytes())
    replace_file(TOP / one.page, text.encode())


def use(one, content, workshop, options):
    """Compares, prints or writes. Returns whether the page is as it is to be."""
    if options.check:
        page = markdown.read_page(TOP / one.page)
        found = differences("\n".join(part_of(page, one)), content)
        for line in found:
            print(f"{one.page}: {one.name}: stale: {line}")
        return not found
    if options.print or options.small:
        last = "(small: not for the page)" if options.small else line_of(one, workshop)
        print(f"{content.rstrip()}\n\n{last}\n")
        return True
    write(one, content, workshop)
    return True


def make(makers, options):
    workshop = Workshop(TOP, options.out, options.build, options.data, options.jobs, options.small,
                        options.again)
    status = DONE
    for one in makers:
        missing = lacks(one, options)
        if missing:
            print(f"{one.page}: {one.name}: left as it is: {missing}")
            status = status or SKIPPED
            continue
        print(f"{one.page}: {one.name} ({one.kind}, {one.minutes:g} min)", flush=True)
        if one.kind == "time" and os.getloadavg()[0] > 1.5:
            print("  its figures are times, and the machine has other work", flush=True)
        workshop.begin()
        try:
            fits = use(one, one.make(workshop), workshop, options)
        except (CommandFailed, LookupError, OSError, ValueError) as error:
            print(f"reproduce: error: {one.page}: {one.name}: {error}", file=sys.stderr)
            fits = False
        status = status if fits else STALE
    # What a check skips is said by its status, too; without it the rest is done.
    return status if status != SKIPPED or options.check else DONE


def main(arguments):
    options = parsed(arguments)
    try:
        if options.audit:
            found = audit.problems(TOP)
            print("\n".join(found), end="\n" if found else "")
            return STALE if found else DONE
        makers = chosen(options)
        if options.list:
            list_makers(makers, options)
            return DONE
        return make(makers, options)
    except markdown.PageError as error:
        print(f"reproduce: error: {error}", file=sys.stderr)
        return BAD_USAGE
    except KeyboardInterrupt:
        print("reproduce: stopped; the same command goes on from here", file=sys.stderr)
        return STOPPED


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
