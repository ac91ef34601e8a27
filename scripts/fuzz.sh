#!/bin/bash
# Fuzzes the parsers of scenes, board files, SVG paths, protocols, commands and checkpoints with libFuzzer under ASan and
# UBSan: builds with clang++ in a folder of its own, then runs one target after the other, from what is kept in
# test/fuzz/corpus and what earlier runs found. Ends with 1 when an input crashes a target, takes 20 s or 2 GB; the input
# is then in BUILD/fuzz/findings. A finding that was repaired belongs into test/fuzz/corpus.
# usage: scripts/fuzz.sh [SECONDS [TARGET...]]       by default 60 s each of all targets
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

seconds="${1:-60}"
[[ "$seconds" =~ ^[1-9][0-9]*$ ]] || die "how many seconds? $seconds, allowed: a whole number above 0"
[ $# -gt 0 ] && shift
all=(scene purpledrop microdrop svg_path protocol command checkpoint)
targets=("$@")
[ ${#targets[@]} -gt 0 ] || targets=("${all[@]}")
for target in "${targets[@]}"; do
  [ -f "$root/test/fuzz/$target.cpp" ] || die "no target $target, allowed: ${all[*]}"
done
[ -n "${DMF_SKIP_INSTALL:-}" ] || "$root/scripts/install_dependencies.sh" --clang

build="$(build_dir)/fuzz"
mkdir -p "$build/findings"
need_space "$build" 1000
cmake -S "$root" -B "$build" -DCMAKE_BUILD_TYPE=Fuzz -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_C_COMPILER=clang \
  -DCMAKE_CXX_FLAGS=-O1 -DDMF_BUILD_ROS=OFF -DDMF_FUZZ=ON >"$build/configure.log" 2>&1 ||
  { tail -n 30 "$build/configure.log" >&2; die "cmake failed, see $build/configure.log"; }
cmake --build "$build" -j "${JOBS:-$(nproc)}" --target "${targets[@]/#/fuzz_}" |
  { grep -v 'Built target' || true; } || die "the build failed"

# Of the seeds outside the corpus the shipped files. Scenes with large label grids take ten seconds each here: the corpus has a
# small one.
mkdir -p "$build/seeds"
grep -L '^label_grid:' "$root"/config/scenes/*.yaml "$root"/test/scenes/*.yaml | xargs cp -t "$build/seeds"
declare -A seeds=(
  [scene]="$build/seeds" [protocol]="$root/config/protocols $root/test/protocols"
  [purpledrop]="" [microdrop]="" [svg_path]="" [command]="" [checkpoint]="")
export DMF_SIM_CONFIG="$root/config" OMP_NUM_THREADS=1 ASAN_OPTIONS=detect_leaks=1
status=0
for target in "${targets[@]}"; do
  mkdir -p "$build/found/$target"
  log="$build/findings/$target.log"
  # shellcheck disable=SC2086
  "$(find "$build" -name "fuzz_$target" -type f -perm -u+x | head -n 1)" -max_total_time="$seconds" -timeout=20 \
    -rss_limit_mb=2048 -max_len=20000 -print_final_stats=1 -artifact_prefix="$build/findings/$target-" \
    "$build/found/$target" "$root/test/fuzz/corpus/$target" ${seeds[$target]} >"$log" 2>&1 ||
    { status=1; grep -m 3 -E 'ERROR|SUMMARY|does not hold|Test unit written' "$log" >&2 || tail -n 5 "$log" >&2; }
  echo "$target: $(grep -oE 'stat::number_of_executed_units: *[0-9]+' "$log" | grep -oE '[0-9]+' || echo 0) inputs," \
    "$(find "$build/found/$target" -type f | wc -l) kept that reach something of their own"
done
exit "$status"
