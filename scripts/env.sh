# Puts the built package into this shell, with a ROS master on this machine only. Sourced, not run:
#   source scripts/env.sh
_dmf_build="$(source "$(dirname "${BASH_SOURCE[0]}")/common.sh" && build_dir)"
if [ -f "$_dmf_build/devel/setup.bash" ]; then
  source "$_dmf_build/devel/setup.bash"
  export ROS_IP=127.0.0.1 ROS_MASTER_URI="${ROS_MASTER_URI:-http://127.0.0.1:11311}"
  unset ROS_HOSTNAME
else
  echo "env.sh: nothing is built yet, run scripts/build.sh first" >&2
fi
unset _dmf_build
