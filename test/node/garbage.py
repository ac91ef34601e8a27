"""Requests that no chip may take: random fields of which at least one is wrong, and bytes that are no request at all."""
import math
import os
import random
import struct

import rospy
from geometry_msgs.msg import Point, Vector3

from chip_client import SERVICES

NAN, INF = math.nan, math.inf
NO_CHANNELS = [4, 9, 77, 2**31, 2**32 - 1]  # of test/scenes/tiny_line.yaml, which has 0 to 3
# So many numbers a list claims to have at least, of which hardly any come.
CLAIM = int(os.environ.get("DMF_TEST_CLAIM", 2**31))
NO_NUMBERS = [NAN, INF, -INF, 1e308, -1e308]


def text(rng, longest=2000):
    return "".join(rng.choice("abz{}[]\"'\\\n\t\0 ä💧:,0") for _ in range(rng.randrange(longest)))


def channels(rng):
    """Some of which at least one does not exist, or is there twice."""
    wrong = [rng.choice(NO_CHANNELS)] if rng.random() < 0.7 else [2, 2]
    more = [rng.randrange(2**32) for _ in range(rng.choice([0, 3, 50, 5000]))]
    result = wrong + more
    rng.shuffle(result)
    return result


def number(rng):
    return rng.choice(NO_NUMBERS + [0.0, -1.0, rng.uniform(-1e9, 1e9)])


def place(rng):
    return rng.choice([rng.uniform(1e-3, 1e9), rng.uniform(-1e9, -1e-3)] + NO_NUMBERS)


def request(name, rng):
    """A request of the service that has to be refused, as the arguments of its proxy."""
    vector = lambda: Vector3(number(rng), number(rng), rng.choice(NO_NUMBERS))  # noqa: E731
    lists = lambda n: [number(rng) for _ in range(n)]  # noqa: E731
    if name in ("set_electrodes", "set_disabled_channels"):
        return (channels(rng),)
    if name == "set_hv":
        return (rng.choice([80.1, -1e-9, 1e30] + NO_NUMBERS), number(rng), rng.random() < 0.5)
    if name == "set_electrode_voltages":
        return (channels(rng), lists(rng.choice([0, 1, 3, 4000])))
    if name == "set_wettability":
        n = rng.choice([0, 1, 2, 30, 20000])
        return (lists(n), lists(n + rng.choice([1, 2])))
    if name == "load_pattern":
        return ("no " + text(rng),)
    if name == "dispense_droplet":
        return (place(rng), number(rng), number(rng), rng.choice([0.0, 1e9] + NO_NUMBERS), rng.choice(["", text(rng)]))
    if name == "add_microparticle":
        return {"x": place(rng), "y": number(rng), "height": number(rng), "radius": number(rng),
                "beads": rng.randrange(2**32), "mass": number(rng), "attraction_mdpd": number(rng),
                "contact_angle_deg": number(rng),
                "points": [Point(number(rng), number(rng), number(rng)) for _ in range(rng.choice([0, 2, 3000]))]}
    if name == "remove":
        return rng.choice([(0, 0), (1, 1), (rng.randrange(100, 2**32), 0), (0, rng.randrange(1, 2**32))])
    if name == "set_body_forces":
        return (vector(), vector())
    if name == "inject_fault":
        return (rng.choice(["", "melted", text(rng)]), rng.randrange(2**32), number(rng), rng.random() < 0.5)
    if name == "explain_droplet":
        return (rng.randrange(100, 2**32),)
    if name == "step":
        return (rng.choice([0, 10**6 + 1, 2**32 - 1]),)
    if name in ("save_checkpoint", "load_checkpoint"):
        return (rng.choice(["", ".", "..", "../up", "/etc/passwd", ".hidden", "a/b", "a b", "x" * 5000, text(rng)]) + "/",)
    raise ValueError(name)


# What has no arguments, or only reads, can't be asked for wrongly.
GARBLED = [name for name in SERVICES if name not in (
    "halt", "detect_shorts", "pause_physics", "unpause_physics", "reset", "get_layout", "get_state", "record_checkpoint")]


def call_raw(name, rng):
    """@returns whether the node took it: a list that is said to be longer than memory is, then noise."""
    data = struct.pack("<I", rng.randrange(CLAIM, 2 * CLAIM)) + rng.randbytes(rng.randrange(200))
    kind = SERVICES[name]
    garbled = type("Garbled", (kind._request_class,), {"serialize": lambda self, buff: buff.write(data)})
    try:
        return rospy.ServiceProxy(f"/chip/{name}", kind).call(garbled()).success
    except (rospy.ServiceException, rospy.exceptions.TransportException):
        return False


RAW = ["set_electrodes", "set_disabled_channels", "set_electrode_voltages", "set_wettability", "load_pattern",
       "save_checkpoint", "load_checkpoint", "inject_fault"]


def flood(calls, seed, raw_share=0.05):
    """Calls services with garbage, one after the other. @returns what was taken all the same."""
    rng = random.Random(seed)
    proxies = {name: rospy.ServiceProxy(f"/chip/{name}", SERVICES[name], persistent=True) for name in GARBLED}
    taken = []
    for _ in range(calls):
        if rng.random() < raw_share:
            name = rng.choice(RAW)
            if call_raw(name, rng):
                taken.append((name, "bytes"))
            continue
        name = rng.choice(GARBLED)
        arguments = request(name, rng)
        try:
            reply = proxies[name](**arguments) if isinstance(arguments, dict) else proxies[name](*arguments)
            if reply.success or not reply.message:
                taken.append((name, repr(arguments)[:300]))
        except rospy.ServiceException:
            # A field that is out of its type's range does not even leave here, or the node refused the bytes.
            proxies[name] = rospy.ServiceProxy(f"/chip/{name}", SERVICES[name], persistent=True)
    return taken
