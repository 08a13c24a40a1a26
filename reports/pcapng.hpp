// Blocks of a pcapng file (draft-ietf-opsawg-pcapng), little-endian, each as the bytes to append.
// libpcap reads this format, but cannot write it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "src/base/bytes.hpp"

namespace fieldproof::reports {

/// SEL RTAC serial: 12 bytes of header before each frame, which say its time and direction.
inline constexpr std::uint16_t linktype_rtac_serial = 250;
/// IPv4 packets as they are.
inline constexpr std::uint16_t linktype_ipv4 = 228;

/// The first block. Texts are UTF-8; an empty one is left out.
std::string pcapng_section(std::string_view application, std::string_view hardware);

/// One interface; the first has number 0. Times of its packets are in nanoseconds.
std::string pcapng_interface(std::uint16_t linktype, std::string_view name,
                             std::string_view description);

struct PcapngPacket {
  std::uint32_t interface = 0;
  std::uint64_t time = 0;  // ns since 1970: the end of the last stop bit, or of the packet
  bool sent = false;       // by the bench, to the device
  ByteView bytes;
  std::string_view comment;
  std::size_t left_out = 0;  // bytes behind these that are not kept
};
/// Bytes as they are on the interface. Readers refuse packets of more than 256 KiB: what is longer
/// is cut there, as its two lengths then say.
std::string pcapng_packet(const PcapngPacket& packet);
/// A frame on an interface of linktype_rtac_serial.
std::string pcapng_serial_packet(const PcapngPacket& frame);

}  // namespace fieldproof::reports
