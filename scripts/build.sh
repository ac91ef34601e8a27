#!/bin/bash
# Builds the package outside its folder, in $DMF_BUILD_DIR or ~/.cache/dmf_sim/build-<number of this checkout>.
# usage: scripts/build.sh [TARGET...]       without targets: everything
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

build=$(build_dir)
case "$(realpath -m "$build")/" in
  "$(realpath "$root")"/*) die "DMF_BUILD_DIR is $build, allowed: a folder outside $root" ;;
esac
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
cmake -S "$root" -B "$build" >"$build/configure.log" 2>&1 ||
  { tail -n 30 "$build/configure.log" >&2; die "cmake failed, see $build/configure.log"; }
cmake --build "$build" -j "$(nproc)" "${targets[@]}" | { grep -v 'Built target' || true; } || die "the build failed"
