"""What bench.py measured, as people read it: a table, a page, a plot."""
import json
import os

TITLES = {
    "W1_bulk_20": "W1 bulk 20³, periodic",
    "W2_droplet_R10": "W2 droplet R = 10 on its wall",
    "W3_droplet_R5": "W3 droplet R = 5 on a 150 × 70 plate",
    "W3_droplet_R5_microparticle": "W3 with a microparticle of 612 beads",
    "W4_bulk_1M": "W4 bulk of a million beads",
}
COLUMNS = ("workload", "beads", "kernel", "threads", "wait", "ns per bead-step", "runs", "spread", "reference/this",
           "1 thread/this", "LAMMPS/this")
LEFT = ("workload", "kernel", "wait")
BUSY = 0.05  # cores; when other programs take more, the figures are not to be trusted


def split(rows):
    """The rows of the workloads, and those of the sizes."""
    return [row for row in rows if row["workload"] in TITLES], [row for row in rows if row["workload"] not in TITLES]


def cells(row):
    """A row's figures as people read them."""
    def ratio(value):
        return "" if value is None else f"{value:.2f}" if value < 10 else f"{value:.0f}"
    runs = len(row["samples"])
    spread = (row["highest"] - row["lowest"]) / row["ns_per_bead_step"]
    return (TITLES.get(row["workload"], "bulk"), f"{row['beads']:,}", row["kernel"], str(row["threads"]),
            row["wait"] if row["threads"] > 1 else "", f"{row['ns_per_bead_step']:,.0f}", str(runs),
            f"{100 * spread:.0f} %" if runs > 1 else "", ratio(row["reference_over_this"]),
            ratio(row["one_thread_over_this"]), ratio(row["lammps_over_this"]))


def text_table(rows):
    lines = [COLUMNS] + [cells(row) for row in rows]
    widths = [max(len(line[k]) for line in lines) for k in range(len(COLUMNS))]
    return "\n".join("  ".join(cell.ljust(width) if name in LEFT else cell.rjust(width)
                               for name, cell, width in zip(COLUMNS, line, widths)).rstrip() for line in lines)


def markdown_table(rows):
    rule = tuple("---" if name in LEFT else "---:" for name in COLUMNS)
    return "\n".join("| " + " | ".join(line) + " |" for line in [COLUMNS, rule] + [cells(row) for row in rows])


def facts(result):
    """Where and how it was measured, a line each."""
    m = result["machine"]
    lines = [f"{m['cpu']} (family {m['cpu_family']}, model {m['cpu_model']}), {m['cores']} cores, {m['cores_allowed']} of "
             f"them allowed; kernels: {', '.join(m['kernels'])}",
             f"{m['compiler']}, {m['flags'].strip()}; version {m['version']}; {m['date']}",
             f"load average at the start {m['load_average'][0]:.2f}; meanwhile other programs took "
             f"{m['others_cores']:.2f} cores" + (": THE FIGURES ARE TOO HIGH" if m["others_cores"] > BUSY else ""),
             "ns per bead-step: median of wall time over moving beads and steps; spread: largest less smallest, over the "
             "median; a/this: how many times as long a takes; wait: OMP_WAIT_POLICY, or the programs' own default"]
    if result["bytes_per_bead"]:
        lines.append(f"peak memory at a million beads: {result['bytes_per_bead']:.0f} bytes a bead")
    return lines + result["notes"]


def print_result(result):
    for table in split(result["results"]):
        if table:
            print(text_table(table) + "\n")
    print("\n".join(facts(result)))


def write_page(result, path, picture):
    workloads, sizes = split(result["results"])
    with open(path, "w") as out:
        out.write(f"# What a step costs on {result['machine']['cpu']}\n\nMade by `scripts/bench.sh`.\n\n")
        out.write("".join(f"- {line}\n" for line in facts(result)) + "\n" + markdown_table(workloads) + "\n")
        if sizes:
            out.write(f"\n![Cost of a bead against their number]({picture})\n\n" + markdown_table(sizes) + "\n")


def draw(result, path):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    workloads, sizes = split(result["results"])
    figure, axes = plt.subplots(figsize=(8, 5), layout="constrained")
    for threads in sorted({row["threads"] for row in sizes}):
        rows = sorted((row for row in sizes if row["threads"] == threads), key=lambda row: row["beads"])
        median = [row["ns_per_bead_step"] for row in rows]
        below = [row["ns_per_bead_step"] - row["lowest"] for row in rows]
        above = [row["highest"] - row["ns_per_bead_step"] for row in rows]
        axes.errorbar([row["beads"] for row in rows], median, (below, above), marker="o", capsize=3,
                      label=f"bulk, {rows[0]['kernel']}, {threads} thread{'s' if threads > 1 else ''}")
    rows = [row for row in workloads if row["kernel"] == sizes[0]["kernel"] and row["threads"] == 1]
    if rows:
        axes.plot([row["beads"] for row in rows], [row["ns_per_bead_step"] for row in rows], "s", color="0.3",
                  markerfacecolor="none", label=f"W1–W4, {rows[0]['kernel']}, 1 thread")
    axes.set(xscale="log", xlabel="moving beads", ylabel="ns per moving bead and step",
             title=f"{result['machine']['cpu']}, {result['machine']['date'][:10]}")
    axes.set_ylim(bottom=0)
    axes.grid(alpha=0.3)
    axes.legend(fontsize="small")
    figure.savefig(path, dpi=110)


def write(result, folder, name):
    """NAME.json, NAME.md and, where sizes were measured, NAME.png. @returns their paths."""
    os.makedirs(folder, exist_ok=True)
    path = os.path.join(folder, name)
    with open(path + ".json", "w") as out:
        json.dump(result, out, indent=1, ensure_ascii=False)
        out.write("\n")
    write_page(result, path + ".md", name + ".png")
    if not split(result["results"])[1]:
        return [path + ".json", path + ".md"]
    draw(result, path + ".png")
    return [path + ".json", path + ".md", path + ".png"]
