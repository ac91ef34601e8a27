#!/bin/bash
# What a step costs: installs what is missing, builds, times the workloads W1 to W4 with every kernel and thread count,
# and LAMMPS in turn with them where there is one; prints a table and writes it as JSON, as a page and as a plot. Takes
# six to seven minutes, and wants the machine for itself.
# usage: scripts/bench.sh [--quick] [--filter REGEX] [--threads 1,2] [--lmp PATH] [--record] [...]
#   --quick    a minute
#   --record   into bench/results, under the name of this processor
#   --help     the rest
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

case " $* " in
  *" --help "* | *" -h "*) ;;
  *)
    "$root/scripts/install_dependencies.sh" --bench
    "$root/scripts/build.sh" --bench
    ;;
esac
exec /usr/bin/python3 "$root/bench/bench.py" --binary "$(build_dir)/benchmarks/bench/bench_step" "$@"
