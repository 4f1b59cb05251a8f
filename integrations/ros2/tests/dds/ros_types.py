"""Types of ROS 2 messages for CycloneDDS, made from published definitions: those of the package rosbags, and those that are given.

They share nothing with the structures of the node, so that a field that is missing there, or of another type or order, is found."""
from cyclonedds.idl import make_idl_struct, types
from rosbags.interfaces import Nodetype
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

BASES = {"bool": bool, "string": str, "float32": types.float32, "float64": types.float64, "uint8": types.uint8, "uint16": types.uint16, "int32": types.int32,
         "uint32": types.uint32, "int64": types.int64, "uint64": types.uint64}

# Fields of Open-RMF's fleet states, version 4.1.0 of rmf_fleet_msgs (Apache-2.0).
FLEETS = {
    "FleetState": "string name\nRobotState[] robots",
    "RobotState": "string name\nstring model\nstring task_id\nuint64 seq\nRobotMode mode\nfloat32 battery_percent\nLocation location\n"
                  "Location[] path",
    "RobotMode": "uint32 mode\nuint64 mode_request_id\nstring performing_action",
    "Location": "builtin_interfaces/Time t\nfloat32 x\nfloat32 y\nfloat32 yaw\nbool obey_approach_speed_limit\n"
                "float32 approach_speed_limit\nstring level_name\nuint64 index",
}

# The service of nav2's route server that closes edges, of nav2_msgs (Apache-2.0).
EDGES = {
    "EdgeCost": "uint16 edgeid\nfloat32 cost",
    "DynamicEdges_Request": "uint16[] closed_edges\nuint16[] opened_edges\nEdgeCost[] adjust_edges",
    "DynamicEdges_Response": "bool success",
}


class Messages:
    def __init__(self, package):
        """`package` is a folder with .msg files, beside the messages of ROS 2 itself."""
        self.store = get_typestore(Stores.ROS2_JAZZY)
        texts = {f"rmf_fleet_msgs/msg/{name}": text for name, text in FLEETS.items()}
        texts |= {f"nav2_msgs/msg/{name}": text for name, text in EDGES.items()}
        texts |= {f"{package.name}/msg/{file.stem}": file.read_text() for file in sorted(package.glob("msg/*.msg"))}
        found = {}
        for name, text in texts.items():
            found |= get_types_from_msg(text, name)
        self.store.register(found)
        self.made = {}

    def constant(self, name, constant):
        return next(value for each, _, value in self.store.fielddefs[name][0] if each == constant)

    def fields(self, name):
        """The fields of a message with their definitions."""
        return dict(self.store.fielddefs[name][1])

    def __getitem__(self, name):
        """The type of a message, such as "nav_msgs/msg/Path"."""
        if name not in self.made:
            fields = {field: self.type_of(definition) for field, definition in self.fields(name).items()}
            package, _, message = name.split("/")
            self.made[name] = make_idl_struct(f"{message}_", f"{package}.msg.dds_.{message}_", fields)
        return self.made[name]

    def service(self, package, name):
        """The types of a request and of its answer, as rmw_cyclonedds_cpp has them on the wire: before the fields are the client and the number of
        its request, which the answer repeats."""
        header = {"client": types.uint64, "number": types.int64}
        fields = {part: {field: self.type_of(definition) for field, definition in self.fields(f"{package}/msg/{name}_{part}").items()}
                  for part in ("Request", "Response")}
        return [make_idl_struct(f"{name}_{part}_", f"{package}.srv.dds_.{name}_{part}_", header | fields[part]) for part in fields]

    def type_of(self, definition):
        node, of = definition
        if node == Nodetype.BASE:
            return BASES[of[0]]
        if node == Nodetype.NAME:
            return self[of]
        if node == Nodetype.SEQUENCE:
            return types.sequence[self.type_of(of[0])]
        raise ValueError(f"{definition}: such a field is not expected here")

    def make(self, name, values):
        """A message of dictionaries and lists. Every field has to be there, and no other one."""
        fields = self.fields(name)
        if set(values) != set(fields):
            raise ValueError(f"{name}: {sorted(set(values) ^ set(fields))}")
        return self[name](**{field: self._value(definition, values[field]) for field, definition in fields.items()})

    def _value(self, definition, value):
        node, of = definition
        if node == Nodetype.NAME:
            return self.make(of, value)
        return [self._value(of[0], each) for each in value] if node == Nodetype.SEQUENCE else value

    def compare(self, name, found, expected, where=""):
        """Compares every field of a message with what is expected: numbers within 1e-6, times within 1e-6 s."""
        where = where or name
        fields = self.fields(name)
        if set(expected) != set(fields):
            raise ValueError(f"{where}: {sorted(set(expected) ^ set(fields))}")
        if name == "builtin_interfaces/msg/Time":
            expected, found = ({"since": time["sec"] + time["nanosec"] * 1e-9 - expected["sec"]} for time in
                               (expected, {"sec": found.sec, "nanosec": found.nanosec}))
            compare_value(where, found["since"], expected["since"])
            return
        for field, definition in fields.items():
            self._compare(f"{where}.{field}", definition, getattr(found, field), expected[field])

    def _compare(self, where, definition, found, expected):
        node, of = definition
        if node == Nodetype.NAME:
            self.compare(of, found, expected, where)
        elif node == Nodetype.SEQUENCE:
            if len(found) != len(expected):
                raise AssertionError(f"{where}: {len(found)} instead of {len(expected)}: {found}")
            for k, (one, other) in enumerate(zip(found, expected)):
                self._compare(f"{where}[{k}]", of[0], one, other)
        else:
            compare_value(where, found, expected)


def compare_value(where, found, expected):
    is_near = abs(found - expected) <= 1e-6 if isinstance(expected, float) else found == expected and type(found) is type(expected)
    if not is_near:
        raise AssertionError(f"{where}: {found!r} instead of {expected!r}")
