"""Types of ROS 2 messages for CycloneDDS, made from published definitions: those of the package rosbags, and .msg files.

They share nothing with the structures of the node, so that a field that is missing there, or of another type or order, is found."""
from cyclonedds.idl import make_idl_struct, types
from rosbags.interfaces import Nodetype
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

BASES = {"bool": bool, "string": str, "float32": types.float32, "float64": types.float64, "uint8": types.uint8, "int32": types.int32,
         "uint32": types.uint32, "int64": types.int64, "uint64": types.uint64}


class Messages:
    def __init__(self, *packages):
        """`packages` are folders with .msg files, beside the messages of ROS 2 itself."""
        self.store = get_typestore(Stores.ROS2_JAZZY)
        found = {}
        for package in packages:
            for file in sorted(package.glob("msg/*.msg")):
                found |= get_types_from_msg(file.read_text(), f"{package.name}/msg/{file.stem}")
        self.store.register(found)
        self.made = {}

    def constants(self, name):
        """The constants of a message, by name."""
        return {constant: value for constant, _, value in self.store.fielddefs[name][0]}

    def fields(self, name):
        return [field for field, _ in self.store.fielddefs[name][1]]

    def __getitem__(self, name):
        """The type of a message, such as "nav_msgs/msg/Path"."""
        if name not in self.made:
            fields = {field: self.type_of(definition) for field, definition in self.store.fielddefs[name][1]}
            package, _, message = name.split("/")
            self.made[name] = make_idl_struct(f"{message}_", f"{package}.msg.dds_.{message}_", fields)
        return self.made[name]

    def type_of(self, definition):
        node, of = definition
        if node == Nodetype.BASE:
            return BASES[of[0]]
        if node == Nodetype.NAME:
            return self[of]
        if node == Nodetype.SEQUENCE:
            return types.sequence[self.type_of(of[0])]
        raise ValueError(f"{definition}: such a field is not expected here")
