// The way of a variable between memory and frame: conversion, swap, and memory as bytes (Cnet
// EN 6.2.5 4)).
#pragma once

#include <optional>

#include "src/plc/memory.hpp"
#include "src/user_frames/frame.hpp"

namespace fieldproof::user_frames {

/// 12 34 to '1234', or '1234' to 12 34; nothing where that is not an even number of hex digits.
std::optional<Bytes> converted(Convert convert, ByteView bytes);

/// Each whole group of `group` bytes turned round; 1: as it is.
Bytes swapped(std::size_t group, ByteView bytes);

/// Do `count` bytes from `address` on lie inside the area?
bool fits_bytes(const plc::PlcModel& model, const plc::DeviceAddress& address, std::size_t count);

/// Memory as bytes: elements in ascending order, each high byte first. They must fit (fits_bytes).
Bytes read_bytes(const plc::PlcMemory& memory, const plc::DeviceAddress& address,
                 std::size_t count);
/// An element that `bytes` end in keeps its lower bytes.
void write_bytes(plc::PlcMemory& memory, const plc::DeviceAddress& address, ByteView bytes);

}  // namespace fieldproof::user_frames
