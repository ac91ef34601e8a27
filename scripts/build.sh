#!/bin/bash
# Builds the package outside its folder, in $DMF_BUILD_DIR or ~/.cache/dmf_sim/build-<number of this checkout>.
# usage: scripts/build.sh [--bench | TARGET...]
#   TARGET    without any: everything
#   --bench   the benchmarks alone, without ROS, in a folder of their own there
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

build=$(build_dir)
case "$(realpath -m "$build")/" in
  "$(realpath "$root")"/*) die "DMF_BUILD_DIR is $build, allowed: a folder outside $root" ;;
esac
options=()
if [ "${1:-}" = --bench ]; then
  [ $# -eq 1 ] || die "--bench takes no targets"
  build="$build/benchmarks"
  options=(-DDMF_BUILD_ROS=OFF -DCATKIN_ENABLE_TESTING=OFF -DDMF_BUILD_BENCHMARKS=ON)
  set -- bench_step bench_checkpoint
fi
mkdir -p "$build" || die "can't create $build"
need_space "$build" 500

# Ubuntu's ROS must be asked for; Debian's lies in /usr.
if [ -f /opt/ros/noetic/setup.bash ]; then
  set +u
  source /opt/ros/noetic/setup.bash
  set -u
fi

targets=()
for target in "$@"; do targets+=(--target "$target"); done
cmake -S "$root" -B "$build" "${options[@]}" >"$build/configure.log" 2>&1 ||
  { tail -n 30 "$build/configure.log" >&2; die "cmake failed, see $build/configure.log"; }
cmake --build "$build" -j "$(nproc)" "${targets[@]}" | { grep -v 'Built target' || true; } || die "the build failed"
