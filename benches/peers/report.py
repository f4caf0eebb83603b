"""The table and its numbers, as Markdown and as JSON."""

import json
import os
import platform
import statistics
from pathlib import Path


def machine():
    cpuinfo = Path("/proc/cpuinfo")
    lines = cpuinfo.read_text().splitlines() if cpuinfo.exists() else []
    models = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return {
        "cpu": models[0] if models else platform.processor(),
        "cores": os.cpu_count(),
        "system": platform.platform(),
        "python": platform.python_version(),
    }


def results(entries, missing, setting):
    """Everything that was measured, for JSON."""
    return {
        **setting,
        "machine": machine(),
        "tools": [
            {
                "name": tool.name,
                "how": tool.how,
                "version": tool.version(),
                "largest_samples_timed": tool.largest_samples,
                "largest_difference": difference,
                "seconds_a_replicate": statistics.median(times.tool),
                "switchback_seconds_a_replicate": statistics.median(times.switchback),
                "nanoseconds_a_sample": 1e9 * statistics.median(times.tool) / setting["grid_samples"],
                "ratio": statistics.median(times.ratios),
                "ratios": times.ratios,
            }
            for tool, times, difference in entries
        ],
        "not_available": missing,
    }


def table(page):
    """The results as Markdown."""
    return "\n".join([*heading(page), "", *rows(page), *footnote(page), "", *particulars(page)]) + "\n"


def heading(page):
    return [
        "# The leaf-spring grid in other tools",
        "",
        f"{page['cells']} cells of `scenarios/leafspring.toml`, {page['grid_samples']:,} samples a replicate; the paper's",
        f"descendant estimate of every cell. One thread, processor time, the median of {page['rounds']} rounds; `×` is the",
        "median over the rounds of the tool's time over Switchback's just before it. The difference is the largest to",
        "Switchback's estimate in any of a, b, F on one of its own replicates.",
    ]


def rows(page):
    yield "| tool | how | seconds a replicate | ns a sample | × | (least – most) | largest difference |"
    yield "|---|---|--:|--:|--:|--:|--:|"
    for row in page["tools"]:
        mark = " ¹" if row["largest_samples_timed"] else ""
        yield (
            f"| {row['name']}{mark} | {row['how']} | {row['seconds_a_replicate']:.3g} "
            f"| {row['nanoseconds_a_sample']:,.0f} | **{row['ratio']:,.0f}** "
            f"| {min(row['ratios']):,.0f} – {max(row['ratios']):,.0f} | {row['largest_difference']:.0e} |"
        )
    for name, reason in page["not_available"].items():
        yield f"| {name} | not available: {reason} | | | | | |"
    seconds = statistics.median(row["switchback_seconds_a_replicate"] for row in page["tools"])
    yield (
        f"| Switchback | {page['switchback']} | {seconds:.3g} | {1e9 * seconds / page['grid_samples']:.2g} | 1 | | |"
    )


def footnote(page):
    slow = [row for row in page["tools"] if row["largest_samples_timed"]]
    if slow:
        timed = "; ".join(f"{row['name']} up to N = {row['largest_samples_timed']:,}" for row in slow)
        yield ""
        yield f"¹ Timed at one border and noise level, every m ({timed}), and taken as the same for"
        yield f"the others; beyond that N as the same a sample. Checked at N = {page['slow_check_samples']:,} only."


def particulars(page):
    machine = page["machine"]
    versions = dict.fromkeys(row["version"] for row in page["tools"])
    return [
        f"Machine: {machine['cpu']}, {machine['cores']} cores, {machine['system']}, Python {machine['python']}.",
        f"Versions: {'; '.join(versions)}.",
        f"Command: `{page['command']}`.",
    ]


def write(page, folder):
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "results.json").write_text(json.dumps(page, indent=2) + "\n")
    (folder / "table.md").write_text(table(page))
