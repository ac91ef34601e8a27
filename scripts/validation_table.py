#!/usr/bin/python3
"""The table of docs/validation.md, made from the runs that are recorded in docs/validation by `dmf_study table`.

    scripts/validation_table.py            # writes it into docs/validation.md
    scripts/validation_table.py --check    # says whether it stands there: 0 when it does

--study PROGRAM: another dmf_study than the one of scripts/env.sh.
"""
import argparse
import os
import shutil
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
DOCUMENT = os.path.join(ROOT, "docs", "validation.md")
BEGIN, END = "<!-- begin of scripts/validation_table.py -->\n", "<!-- end of scripts/validation_table.py -->\n"


def table(study):
    result = subprocess.run([study, "table", "--out", os.path.join(ROOT, "docs", "validation")], check=True,
                            stdout=subprocess.PIPE, universal_newlines=True,
                            env={"DMF_SIM_CONFIG": os.path.join(ROOT, "config"), **os.environ})
    return result.stdout


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--study")
    options = parser.parse_args()
    study = options.study or shutil.which("dmf_study") or shutil.which(
        "dmf_study", path=os.pathsep.join(os.path.join(prefix, "lib", "dmf_sim")
                                          for prefix in os.environ.get("CMAKE_PREFIX_PATH", "").split(":")))
    if not study:
        sys.exit("no dmf_study: `source scripts/env.sh` first, or say --study PROGRAM")
    with open(DOCUMENT, encoding="utf-8") as file:
        old = file.read()
    before, rest = old.split(BEGIN)
    _, after = rest.split(END)
    new = before + BEGIN + table(study) + END + after
    if options.check:
        sys.exit(0 if new == old else
                 "docs/validation.md: its table is not what docs/validation gives, run scripts/validation_table.py")
    with open(DOCUMENT, "w", encoding="utf-8") as file:
        file.write(new)


if __name__ == "__main__":
    main()
