# Shared by the scripts here; sourced, not run.

# A python3 of the user's own ahead of /usr/bin would be taken for ROS's.
export PATH="/usr/bin:/bin:$PATH"

root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"

# die MESSAGE: one clear line, and the end.
die() {
  echo "$(basename "$0"): $*" >&2
  exit 1
}

# Where this checkout is built. Never inside it: rosrun would find no executable then.
build_dir() {
  echo "${DMF_BUILD_DIR:-$HOME/.cache/dmf_sim/build-$(printf %s "$root" | cksum | cut -d' ' -f1)}"
}

# need_space DIR MEGABYTES: DIR must exist.
need_space() {
  local free
  free=$(df --output=avail --block-size=1M "$1" | tail -n 1 | tr -d ' ')
  [ "$free" -ge "$2" ] || die "$1 has $free MB left, $2 MB are needed"
}

# Puts the built package into the environment. setup.bash reads variables that may be unset, and overwrites the
# positional parameters that it is given.
use_build() {
  local setup="$1/devel/setup.bash"
  [ -f "$setup" ] || die "$setup is missing, run scripts/build.sh first"
  set +u
  # shellcheck disable=SC1090
  source "$setup"
  set -u
}

# Nothing that these scripts start listens wider than this machine: ROS 1 has no authentication.
loopback_only() {
  export ROS_IP=127.0.0.1
  unset ROS_HOSTNAME
}
