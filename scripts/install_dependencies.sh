#!/bin/bash
# Installs the Debian packages that building, running and testing need, when any is missing.
# usage: scripts/install_dependencies.sh [--rviz | --bench | --clang]
#   --rviz    RViz too
#   --bench   what scripts/bench.sh needs and no more: nothing of ROS
#   --clang   clang with its sanitizers and OpenMP too, for scripts/fuzz.sh and scripts/sanitize.sh
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

packages=(
  g++ cmake make ca-certificates
  # the engine and the chip
  libeigen3-dev libhwy-dev libyaml-cpp-dev libfmt-dev libcli11-dev nlohmann-json3-dev libtinyxml2-dev libpng-dev libboost-dev
  # pictures
  python3-numpy python3-matplotlib
)
ros=(
  # build
  catkin ros-message-generation libroscpp-dev libtf2-ros-dev libactionlib-dev libactionlib-msgs-dev librosbag-storage-dev
  libstd-msgs-dev libstd-srvs-dev libgeometry-msgs-dev libsensor-msgs-dev libvisualization-msgs-dev
  libdiagnostic-msgs-dev libros-rosgraph-msgs-dev
  ros-std-msgs ros-std-srvs ros-geometry-msgs ros-sensor-msgs ros-visualization-msgs ros-diagnostic-msgs
  ros-actionlib-msgs ros-rosgraph-msgs
  # run
  rosbash rosout python3-roslaunch python3-rostopic python3-rosservice python3-rosnode python3-rosparam
  python3-rosmsg python3-rosbag python3-rospy python3-actionlib python3-actionlib-msgs
  python3-std-msgs python3-std-srvs python3-geometry-msgs python3-sensor-msgs python3-visualization-msgs
  python3-diagnostic-msgs python3-rosgraph-msgs python3-tf2-msgs
  # test
  libgtest-dev librostest-dev python3-rostest
)
case "$*" in
  "") packages+=("${ros[@]}") ;;
  --rviz) packages+=("${ros[@]}" rviz) ;;
  --bench) packages+=(libbenchmark-dev) ;;
  --clang) packages+=("${ros[@]}" clang libclang-rt-14-dev libomp-dev) ;;
  *) die "unknown options $*, allowed: --rviz, --bench or --clang" ;;
esac

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f '${Status}' "$package" 2>/dev/null || true)
  [ "$status" = "install ok installed" ] || missing+=("$package")
done
[ ${#missing[@]} -gt 0 ] || exit 0

echo "installing ${#missing[@]} packages: ${missing[*]}"
as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null ||
    die "packages are missing and there is neither root nor sudo; as root: apt-get install ${missing[*]}"
  as_root=(sudo)
fi
export DEBIAN_FRONTEND=noninteractive
log=$(mktemp)
trap 'rm -f "$log"' EXIT
"${as_root[@]}" apt-get update >"$log" 2>&1 ||
  { cat "$log" >&2; die "apt-get update failed, is there a network?"; }
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "${missing[@]}" \
  >"$log" 2>&1 || { tail -n 20 "$log" >&2; die "apt-get install failed"; }
