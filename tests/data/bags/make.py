#!/usr/bin/env python3
"""make.py FOLDER: writes the bags of the tests, by the Python packages rosbags (messages and definitions) and mcap (container), which share
nothing with the reader: pip install rosbags==0.11.9 mcap==1.6.0 lz4 zstandard

Two vehicles cross at (3, 0): `left` drives along x, 1 m/s, from (0, 0), and `up` along y, 1 m/s, from (3, -3), both for 6 s, a pose each 0.5 s.
Their centres are nearest at 3 s, at 0 m. Definitions of Open-RMF are those of rmf_internal_msgs, of which the reader is told by the bag.
"""

import math
import sys
from pathlib import Path

import numpy
from mcap.writer import CompressionType, Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

STORE = get_typestore(Stores.ROS2_JAZZY)
RMF = {
    "Location": "builtin_interfaces/Time t\nfloat32 x\nfloat32 y\nfloat32 yaw\nbool obey_approach_speed_limit\n"
                "float32 approach_speed_limit\nstring level_name\nuint64 index\n",
    "RobotMode": "uint32 mode\nuint32 MODE_IDLE=0\nuint32 MODE_MOVING=2\nuint64 mode_request_id\nstring performing_action\n",
    "RobotState": "string name\nstring model\nstring task_id\nuint64 seq\nrmf_fleet_msgs/RobotMode mode\nfloat32 battery_percent\n"
                  "rmf_fleet_msgs/Location location\nrmf_fleet_msgs/Location[] path\n",
    "FleetState": "string name\nrmf_fleet_msgs/RobotState[] robots\n",
}
for name, text in RMF.items():
    STORE.register(get_types_from_msg(text, f"rmf_fleet_msgs/msg/{name}"))
T = STORE.types
START = 1_780_000_000
STEPS = range(13)


class Bag:
    """A bag, of which channels are told when they are first written to."""

    def __init__(self, path, compression, **options):
        self.file = open(path, "wb")
        self.writer = Writer(self.file, compression=compression, **options)
        self.writer.start(profile="ros2", library="make.py")
        self.channels = {}

    def write(self, topic, message, seconds):
        kind = message.__msgtype__
        if topic not in self.channels:
            definition, _ = STORE.generate_msgdef(kind, ros_version=2)
            schema = self.writer.register_schema(name=kind, encoding="ros2msg", data=definition.encode())
            self.channels[topic] = self.writer.register_channel(topic=topic, message_encoding="cdr", schema_id=schema)
        at = round((START + seconds) * 1e9)
        self.writer.add_message(self.channels[topic], log_time=at, publish_time=at, data=bytes(STORE.serialize_cdr(message, kind)))

    def finish(self):
        self.writer.finish()
        self.file.close()


def stamp(seconds):
    return T["builtin_interfaces/msg/Time"](sec=START + math.floor(seconds), nanosec=round(seconds % 1 * 1e9))


def header(seconds, frame):
    return T["std_msgs/msg/Header"](stamp=stamp(seconds), frame_id=frame)


def turn(heading):
    return T["geometry_msgs/msg/Quaternion"](x=0.0, y=0.0, z=math.sin(heading / 2), w=math.cos(heading / 2))


def pose(x, y, heading):
    return T["geometry_msgs/msg/Pose"](position=T["geometry_msgs/msg/Point"](x=x, y=y, z=0.0), orientation=turn(heading))


def transform(seconds, parent, child, x, y, heading):
    vector = T["geometry_msgs/msg/Vector3"](x=x, y=y, z=0.0)
    return T["geometry_msgs/msg/TransformStamped"](
        header=header(seconds, parent), child_frame_id=child, transform=T["geometry_msgs/msg/Transform"](translation=vector, rotation=turn(heading)))


def places(seconds):
    return {"left": (seconds, 0.0, 0.0), "up": (3.0, seconds - 3.0, math.pi / 2)}


def covariance():
    return numpy.zeros(36)


def localized(path):
    """One vehicle by PoseWithCovarianceStamped, one by Odometry in the frame map; a goal, and a topic without poses. Chunks in zstd."""
    bag = Bag(path, CompressionType.ZSTD, chunk_size=1500)
    zero = T["geometry_msgs/msg/Vector3"](x=0.0, y=0.0, z=0.0)
    for step in STEPS:
        seconds = step / 2
        for vehicle, (x, y, heading) in places(seconds).items():
            with_covariance = T["geometry_msgs/msg/PoseWithCovariance"](pose=pose(x, y, heading), covariance=covariance())
            if vehicle == "left":
                bag.write("/left/amcl_pose", T["geometry_msgs/msg/PoseWithCovarianceStamped"](header=header(seconds, "map"), pose=with_covariance), seconds)
            else:
                twist = T["geometry_msgs/msg/TwistWithCovariance"](twist=T["geometry_msgs/msg/Twist"](linear=zero, angular=zero), covariance=covariance())
                bag.write("/up/ground_truth", T["nav_msgs/msg/Odometry"](header=header(seconds, "map"), child_frame_id="base_link", pose=with_covariance, twist=twist), seconds)
        bag.write("/left/note", T["std_msgs/msg/String"](data=f"step {step}"), seconds)
    bag.write("/left/goal_pose", T["geometry_msgs/msg/PoseStamped"](header=header(0, "map"), pose=pose(6.0, 0.0, 0.0)), 6)
    bag.finish()


def frames(path):
    """Both by tf: map -> odom -> base_footprint -> base_link, of `left` with an odometry that is turned and moved. Chunks in lz4."""
    bag = Bag(path, CompressionType.LZ4, chunk_size=2000)
    TF = T["tf2_msgs/msg/TFMessage"]
    bag.write("/tf_static", TF(transforms=[transform(0, f"{name}/base_footprint", f"{name}/base_link", 0.0, 0.0, 0.0) for name in ("left", "up")]), 0)
    for step in STEPS:
        seconds = step / 2
        for vehicle, (x, y, heading) in places(seconds).items():
            # What localization says comes less often, and reaches beyond the last pose.
            if step % 4 == 0:
                offset = (1.0, 2.0, math.pi / 2) if vehicle == "left" else (0.0, 0.0, 0.0)
                bag.write("/tf", TF(transforms=[transform(seconds, "map", f"{vehicle}/odom", *offset)]), seconds)
            if vehicle == "left":
                # (x, y) in map, seen from an odometry at (1, 2) that is turned by a quarter to the left.
                x, y, heading = y - 2.0, 1.0 - x, heading - math.pi / 2
            bag.write("/tf", TF(transforms=[transform(seconds, f"{vehicle}/odom", f"{vehicle}/base_footprint", x, y, heading)]), seconds)
    bag.finish()


def fleet(path):
    """Both by states of an Open-RMF fleet. No chunks are compressed."""
    bag = Bag(path, CompressionType.NONE)
    for step in STEPS:
        seconds = step / 2
        robots = []
        for vehicle, (x, y, heading) in places(seconds).items():
            location = T["rmf_fleet_msgs/msg/Location"](t=stamp(seconds), x=x, y=y, yaw=heading, obey_approach_speed_limit=False, approach_speed_limit=0.0, level_name="L1", index=0)
            mode = T["rmf_fleet_msgs/msg/RobotMode"](mode=2, mode_request_id=0, performing_action="")
            robots.append(T["rmf_fleet_msgs/msg/RobotState"](name=vehicle, model="cart", task_id="", seq=step, mode=mode, battery_percent=90.0, location=location, path=[location]))
        bag.write("/fleet_states", T["rmf_fleet_msgs/msg/FleetState"](name="carts", robots=robots), seconds)
    bag.finish()


def plans(path):
    """Plans of both, as paths with times, without chunks, with a checksum of all data."""
    bag = Bag(path, CompressionType.NONE, use_chunking=False, enable_data_crcs=True)
    for vehicle in places(0):
        poses = [T["geometry_msgs/msg/PoseStamped"](header=header(step / 2, "map"), pose=pose(*places(step / 2)[vehicle])) for step in STEPS]
        bag.write(f"/{vehicle}/plan", T["nav_msgs/msg/Path"](header=header(0, "map"), poses=poses), 0)
    bag.finish()


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    for write in (localized, frames, fleet, plans):
        write(folder / f"{write.__name__}.mcap")
