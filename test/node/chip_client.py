"""What the node's tests share: proxies of all services, and waiting for messages by wall time."""
import os
import threading
import time
import xmlrpc.client

import rosgraph
import rospy
from dmf_sim import srv
from std_srvs.srv import Empty, Trigger

# How much longer than usual to wait: sanitize.sh sets it.
PATIENCE = float(os.environ.get("DMF_TEST_PATIENCE", "1"))

SERVICES = {
    "set_electrodes": srv.SetElectrodes,
    "set_hv": srv.SetHv,
    "set_electrode_voltages": srv.SetElectrodeVoltages,
    "set_wettability": srv.SetWettability,
    "load_pattern": srv.LoadPattern,
    "dispense_droplet": srv.DispenseDroplet,
    "add_microparticle": srv.AddMicroparticle,
    "remove": srv.Remove,
    "set_body_forces": srv.SetBodyForces,
    "halt": Trigger,
    "set_disabled_channels": srv.SetDisabledChannels,
    "detect_shorts": srv.DetectShorts,
    "inject_fault": srv.InjectFault,
    "explain_droplet": srv.ExplainDroplet,
    "pause_physics": Empty,
    "unpause_physics": Empty,
    "step": srv.Step,
    "reset": Trigger,
    "save_checkpoint": srv.Checkpoint,
    "record_checkpoint": Trigger,
    "load_checkpoint": srv.Checkpoint,
    "get_layout": srv.GetLayout,
    "get_state": srv.GetState,
}


class Chip:
    """The chip node's services as methods: chip.step(10), chip.set_hv(63, 1000, True)."""

    def __init__(self, name="/chip"):
        for service, kind in SERVICES.items():
            rospy.wait_for_service(f"{name}/{service}", 20 * PATIENCE)
            setattr(self, service, rospy.ServiceProxy(f"{name}/{service}", kind, persistent=True))

    def hash(self):
        return self.get_state(True).state.state_hash


def pid_of(node):
    """The process of a node on this machine."""
    uri = rosgraph.Master("/chip_client").lookupNode(node)
    return xmlrpc.client.ServerProxy(uri).getPid("/chip_client")[2]


def memory_of(pid, kind="VmRSS"):
    """Of a process, MB: VmRSS now, VmHWM its peak."""
    with open(f"/proc/{pid}/status") as status:
        for line in status:
            if line.startswith(kind + ":"):
                return int(line.split()[1]) * 1024 / 1e6
    raise AssertionError(f"process {pid} has no {kind}")


class Listener:
    """Keeps all messages of a topic."""

    def __init__(self, topic, kind):
        self.messages = []
        self._changed = threading.Condition()
        self._subscriber = rospy.Subscriber(topic, kind, self._on_message, queue_size=None)

    def _on_message(self, message):
        with self._changed:
            self.messages.append(message)
            self._changed.notify_all()

    def wait(self, condition=lambda message: True, timeout=20):
        """The first message, of those that came or come, that meets the condition."""
        until = time.monotonic() + timeout * PATIENCE
        looked_at = 0
        with self._changed:
            while True:
                for message in self.messages[looked_at:]:
                    if condition(message):
                        return message
                looked_at = len(self.messages)
                if not self._changed.wait(until - time.monotonic()) and time.monotonic() >= until:
                    raise AssertionError(f"waited {timeout} s in vain on {self._subscriber.name}")

    def stop(self):
        self._subscriber.unregister()
