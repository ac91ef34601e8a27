#!/bin/bash
# Installs what is missing, builds, and runs the tests. The exit status and the closing line are ctest's.
# usage: scripts/test.sh [--full]           --full: the long physics validation too
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

selection=(--label-exclude '^long$')
targets=(all tests)
while [ $# -gt 0 ]; do
  case "$1" in
    --full) selection=() targets+=(long_tests) ;;
    *) die "unknown option $1, allowed: --full" ;;
  esac
  shift
done

"$root/scripts/install_dependencies.sh"
"$root/scripts/build.sh" "${targets[@]}"
build=$(build_dir)
use_build "$build"
loopback_only
export ROS_HOME="$build/ros_home"

cd "$build"
exec ctest --output-on-failure --parallel "$(nproc)" "${selection[@]}"
