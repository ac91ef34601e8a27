#!/bin/bash
# From nothing to a recorded run: installs what is missing, builds, starts a master and the chip on loopback, lets a
# controller carry a microparticle with a droplet to a target electrode and leave it there, by service calls alone,
# records everything, and ends with a summary, a picture, and the proof that the recording is the run.
# usage: scripts/demo.sh [--rviz] [--out DIR] [--port PORT] [--scene SCENE] [--target CHANNEL] [--seed SEED]
#   --rviz    look at it while it runs
#   --out     where bag, picture and logs go; default out/demo in this checkout
#   --port    of the ROS master; default: any that is free
#   --scene   default delivery_line; one without a microparticle (electrode_line) has its droplet driven alone
#   --target  where the particle is to be left; default: three electrodes after it, channel 5 of delivery_line
#   --seed    in place of the scene's
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

out="$root/out/demo"
port=""
rviz=false
scene=delivery_line
target=""
seed=""
value() { [ $# -ge 2 ] || die "$1 needs a value"; echo "$2"; }
while [ $# -gt 0 ]; do
  case "$1" in
    --rviz) rviz=true ;;
    --out) out=$(value "$@"); shift ;;
    --port) port=$(value "$@"); shift ;;
    --scene) scene=$(value "$@"); shift ;;
    --target) target=$(value "$@"); shift ;;
    --seed) seed=$(value "$@"); shift ;;
    *) die "unknown option $1, allowed: --rviz, --out DIR, --port PORT, --scene SCENE, --target CHANNEL, --seed SEED" ;;
  esac
  shift
done
[[ "$port" =~ ^[0-9]*$ ]] && [ "${port:-1}" -ge 1 ] && [ "${port:-1}" -le 65535 ] ||
  die "--port: $port, allowed: 1 to 65535"
[ "$scene" != delivery_line ] || target="${target:-5}"
[[ "$target" =~ ^[0-9]*$ ]] || die "--target: $target, allowed: a channel of the scene"

# Prints the port if it can be had; without an argument any that is free.
free_port() {
  /usr/bin/python3 - "${1:-0}" <<'PYTHON'
import socket, sys
with socket.socket() as probe:
    probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        probe.bind(("127.0.0.1", int(sys.argv[1])))
    except OSError:
        sys.exit(1)
    print(probe.getsockname()[1])
PYTHON
}

if $rviz; then
  [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ] || die "--rviz needs a display, and DISPLAY is not set"
  "$root/scripts/install_dependencies.sh" --rviz
else
  "$root/scripts/install_dependencies.sh"
fi
mkdir -p "$out/log" 2>/dev/null || die "can't create $out/log"
[ -w "$out" ] || die "can't write to $out"
out=$(cd "$out" && pwd)
need_space "$out" 500
asked_port="$port"
port=$(free_port "$asked_port") || die "port $asked_port of 127.0.0.1 is taken; leave out --port to use a free one"

"$root/scripts/build.sh" chip resimulate dmf_sim_generate_messages
use_build "$(build_dir)"
loopback_only
export ROS_MASTER_URI="http://127.0.0.1:$port"
export ROS_LOG_DIR="$out/log"

# Every process that is started here, and nothing else, is ended when this script ends, however it ends. roslaunch
# and roscore end their own children when they are asked to end.
started=()
stop() {
  local pid="$1"
  kill -0 "$pid" 2>/dev/null || return 0
  kill -TERM "$pid" 2>/dev/null || true
  wait "$pid" 2>/dev/null || true
}
cleanup() {
  trap '' INT TERM
  local i
  for ((i = ${#started[@]} - 1; i >= 0; i--)); do stop "${started[i]}"; done
}
trap cleanup EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

# fail MESSAGE LOG: the one clear line, and where to look.
fail() { die "$1; see $2"; }

echo "master and chip on $ROS_MASTER_URI, logs in $out/log"
roscore -p "$port" >"$out/log/roscore.txt" 2>&1 &
master=$!
started+=("$master")
for ((i = 0; i < 100; i++)); do
  rosparam get /rosdistro >/dev/null 2>&1 && break
  kill -0 "$master" 2>/dev/null || fail "the ROS master did not start" "$out/log/roscore.txt"
  sleep 0.2
done
rosparam get /rosdistro >/dev/null 2>&1 || fail "the ROS master does not answer" "$out/log/roscore.txt"

bag="$out/demo.bag"
rm -f "$bag" "$bag.active" "$out/demo.png"
# Few frames of beads unless somebody looks: they are most of the bag.
roslaunch dmf_sim chip.launch scene:="$scene" seed:="$seed" rviz:=$rviz record:=true bag:="$bag" \
  display_rate:=$($rviz && echo 10 || echo 2) >"$out/log/chip.txt" 2>&1 &
chip=$!
started+=("$chip")

# The recorder before the controller, so that nothing is missed.
for ((i = 0; i < 150; i++)); do
  [ -f "$bag.active" ] && break
  kill -0 "$chip" 2>/dev/null || break
  sleep 0.2
done

rosrun dmf_sim demo_controller.py __name:=demo_controller _target:="${target:--1}" &
controller=$!
started+=("$controller")
status=0
wait -n "$controller" "$chip" || status=$?
if kill -0 "$controller" 2>/dev/null; then
  reason=$(grep -m 1 -o -E '(chip: |RLException: |ERROR: ).*' "$out/log/chip.txt" || echo "no reason given")
  fail "the chip ended: $reason" "$out/log/chip.txt"
fi
[ "$status" -eq 0 ] || fail "the controller did not reach its goal" "$out/log/chip.txt"

stop "$chip"  # closes the bag
[ -f "$bag" ] || fail "nothing was recorded" "$out/log/chip.txt"
rosrun dmf_sim summarize_run.py "$bag" --picture "$out/demo.png" ${target:+--target "$target"} ||
  die "the bag $bag could not be summarized"
# The bag is all that it takes to have the run again. Its first steps are enough to show that, in seconds.
echo "computed again from the bag, its first 2000 steps (all of it: rosrun dmf_sim resimulate $bag):"
rosrun dmf_sim resimulate --quiet --run 0 --until 2000 "$bag" || die "the run is not the one in $bag"
