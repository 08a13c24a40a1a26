#include "src/user_frames/variable.hpp"

#include <algorithm>

namespace fieldproof::user_frames {

std::optional<Bytes> converted(Convert convert, ByteView bytes) {
  if (convert == Convert::none) return Bytes(bytes.begin(), bytes.end());
  Bytes out;
  if (convert == Convert::hex_to_ascii) {
    for (const Byte b : bytes)
      for (const char c : hex_number(b, 2)) out.push_back(static_cast<Byte>(c));
    return out;
  }
  if (bytes.size() % 2 != 0) return std::nullopt;
  for (std::size_t i = 0; i < bytes.size(); i += 2) {
    const int high = hex_digit(static_cast<char>(bytes[i])),
              low = hex_digit(static_cast<char>(bytes[i + 1]));
    if (high < 0 || low < 0) return std::nullopt;
    out.push_back(static_cast<Byte>(high << 4 | low));
  }
  return out;
}

Bytes swapped(std::size_t group, ByteView bytes) {
  Bytes out(bytes.begin(), bytes.end());
  for (auto at = out.begin(); static_cast<std::size_t>(out.end() - at) >= group;
       at += static_cast<std::ptrdiff_t>(group))
    std::reverse(at, at + static_cast<std::ptrdiff_t>(group));
  return out;
}

namespace {
std::uint32_t elements(const plc::DeviceAddress& address, std::size_t bytes) {
  const std::size_t each = plc::type_bytes(address.type);
  return static_cast<std::uint32_t>((bytes + each - 1) / each);
}
}  // namespace

bool fits_bytes(const plc::PlcModel& model, const plc::DeviceAddress& address, std::size_t count) {
  return count == 0 || plc::fits(model, address, elements(address, count));
}

Bytes read_bytes(const plc::PlcMemory& memory, const plc::DeviceAddress& address,
                 std::size_t count) {
  Bytes bytes;
  for (std::uint32_t i = 0; i < elements(address, count); ++i) {
    const std::uint64_t value = memory.read(address + i);
    for (unsigned shift = 8 * plc::type_bytes(address.type); shift > 0; shift -= 8)
      bytes.push_back(static_cast<Byte>(value >> (shift - 8)));
  }
  bytes.resize(count);
  return bytes;
}

void write_bytes(plc::PlcMemory& memory, const plc::DeviceAddress& address, ByteView bytes) {
  const std::size_t each = plc::type_bytes(address.type);
  for (std::uint32_t i = 0; i < elements(address, bytes.size()); ++i) {
    std::uint64_t value = memory.read(address + i);
    for (std::size_t k = 0; k < each && i * each + k < bytes.size(); ++k) {
      const unsigned shift = static_cast<unsigned>(8 * (each - 1 - k));
      value = (value & ~(std::uint64_t{0xFF} << shift)) | std::uint64_t{bytes[i * each + k]}
                                                              << shift;
    }
    memory.write(address + i, value);
  }
}

}  // namespace fieldproof::user_frames
