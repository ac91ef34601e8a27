#!/bin/bash
# Builds with a sanitizer, in a folder of its own beside the usual one, and runs the quick tests of engine, chip,
# controller and node under it. The exit status is 0 when all pass and nothing was reported.
# usage: scripts/sanitize.sh address|thread [TESTS]
#   address   AddressSanitizer and UndefinedBehaviorSanitizer, with g++
#   thread    ThreadSanitizer, with clang++, whose OpenMP tells it about its barriers
#   TESTS     a regular expression, as of ctest -R; without one all of them
# JOBS in the environment: compilers, then tests at a time (a compiler takes up to 2 GB), by default one a processor.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

kind="${1:-}"
tests="${2:-.}"
common=(-fno-omit-frame-pointer -g1 -O1)
case "$kind" in
  address)
    compiler=g++
    flags=("${common[@]}" -fsanitize=address,undefined -fno-sanitize-recover=undefined)
    ;;
  thread)
    compiler=clang++
    flags=("${common[@]}" -fsanitize=thread)
    "$root/scripts/install_dependencies.sh" --clang
    ;;
  *) die "which sanitizer? allowed: address or thread" ;;
esac
[ -n "${DMF_SKIP_INSTALL:-}" ] || "$root/scripts/install_dependencies.sh"

build="$(build_dir)/$kind"
mkdir -p "$build"
need_space "$build" 3000
if [ -f /opt/ros/noetic/setup.bash ]; then
  set +u
  source /opt/ros/noetic/setup.bash
  set -u
fi
# A build type that has no flags of its own: assertions stay on.
cmake -S "$root" -B "$build" -DCMAKE_BUILD_TYPE=Sanitize -DCMAKE_CXX_COMPILER="$compiler" \
  -DCMAKE_CXX_FLAGS="${flags[*]}" >"$build/configure.log" 2>&1 ||
  { tail -n 30 "$build/configure.log" >&2; die "cmake failed, see $build/configure.log"; }
for folder in test/engine test/chip test/controller test/node; do
  make -C "$build/$folder" -j "${JOBS:-$(nproc)}" --no-print-directory | { grep -v 'Built target' || true; } ||
    die "the build failed"
done
cmake --build "$build" -j "${JOBS:-$(nproc)}" --target chip chip_controller move_droplet resimulate |
  { grep -v 'Built target' || true; } || die "the build failed"

use_build "$build"
loopback_only
export ROS_HOME="$build/ros_home"
# Nodes die far from their tests: what they report goes into files, and any such file is a failure.
reports="$build/reports"
rm -rf "$reports"
mkdir -p "$reports"
export OMP_NUM_THREADS=2
# Tests of the node wait by wall time, and everything takes ten times as long.
export DMF_TEST_PATIENCE=10
export DMF_TEST_TIME_LIMIT=3000
# roscpp leaves singletons behind, and the cells of graphs that the loader keeps.
printf 'leak:libros\nleak:librosconsole\nleak:liblog4cxx\nleak:libapr\nleak:libcrypto\n' >"$build/leaks"
export LSAN_OPTIONS="suppressions=$build/leaks print_suppressions=0"
# A request that asks for too much memory is an exception in the node, but the end of one with a sanitizer.
export DMF_TEST_CLAIM=$((1 << 22))
export ASAN_OPTIONS="log_path=$reports/address detect_stack_use_after_return=1 strict_string_checks=1"
export UBSAN_OPTIONS="log_path=$reports/undefined print_stacktrace=1"
# roscpp is not instrumented and would drown everything else. Boost counts the references to a message in its copy of
# release(), too: who lets go of the last one seems to race with those before. Actionlib's client reads its state without
# the lock that it writes it with (examples/move_droplet.cpp).
printf 'race:%s\n' boost::detail::sp_counted_base::release ros::PeerConnDisconnCallback actionlib::SimpleActionClient \
  >"$build/races"
export TSAN_OPTIONS="log_path=$reports/thread ignore_noninstrumented_modules=1 detect_deadlocks=0 suppressions=$build/races"
if [ "$kind" = thread ]; then
  OMP_TOOL_LIBRARIES="$(find /usr/lib/llvm-* -name 'libarcher.so' | head -n 1)"
  [ -n "$OMP_TOOL_LIBRARIES" ] || die "libarcher.so is missing, it is in Debian's libomp5"
  export OMP_TOOL_LIBRARIES
fi

status=0
for folder in test/engine test/chip test/controller test/node; do
  # What asks for memory or time as such is another matter under a sanitizer.
  ctest --test-dir "$build/$folder" --output-on-failure --label-exclude '^long$' --parallel "${JOBS:-$(nproc)}" \
    -R "$tests" -E 'test_memory|overload' || status=1
done
if [ -n "$(ls -A "$reports")" ]; then
  head -n 40 "$reports"/* >&2
  echo "$(basename "$0"): reports in $reports" >&2
  status=1
fi
exit "$status"
