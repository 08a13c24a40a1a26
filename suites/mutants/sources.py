"""Which sources are broken: whatever decides what a device does. The rest of src/ is copied as it is."""

import fnmatch

# Folder of src/, and the protocol that it is reported under.
PROTOCOLS = {
    "email": "e-mail",
    "hs_link": "high-speed link",
    "ls_bus": "LS Bus",
    "modbus": "Modbus",
    "p2p": "P2P, all protocols",
    "plc": "PLC, all protocols",
    "udata": "UDATA",
    "user_frames": "user-defined frames",
    "xgt_cnet": "XGT Cnet",
    "xgt_fenet": "XGT FEnet",
    "xnet": "XINJE PLC",
    "xnet_motion": "X-NET motion bus",
    "xnet_network": "X-NET fieldbus",
}

# What is no device: it reads what a bench or a vector says, joins two benches, or records what a
# device did.
LEFT_OUT = [
    "*_test.cpp",
    "*/test_*",
    "src/base/*",
    "src/line/*",
    "src/net/*",
    "src/email/settings.*",
    "src/hs_link/parameter.*",
    "src/p2p/parameters.*",
    "src/plc/config_reader.*",
    "src/plc/port_config.*",
    "src/plc/frame_monitor.*",
    "src/plc/multi_drop.*",
    "src/udata/config.*",
    "src/udata/instruction_reader.*",
    "src/user_frames/definition.*",
    "src/user_frames/segment_reader.*",
    "src/xgt_cnet/plc_config.*",
    "src/xnet/words.hpp",
    "src/xnet_motion/axis_recorder.*",
    "src/xnet_network/configuration.*",
    "src/xnet_network/instruction.cpp",
    "src/xnet_network/partner.cpp",
    "src/xnet_network/served_plc.*",
]


def is_device(path):
    """`path`: of a source, from the root of the project."""
    return not any(fnmatch.fnmatch(path, pattern) for pattern in LEFT_OUT)


def protocol_of(path):
    return PROTOCOLS[path.split("/")[1]]
