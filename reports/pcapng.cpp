#include "reports/pcapng.hpp"

#include <algorithm>

namespace fieldproof::reports {
namespace {

constexpr std::size_t largest_packet = 262'144;  // WTAP_MAX_PACKET_SIZE_STANDARD of Wireshark

// Block types and option codes of the draft.
constexpr std::uint32_t section_header = 0x0A0D0D0A, interface_description = 1, enhanced_packet = 6;
constexpr std::uint16_t end_of_options = 0, comment_option = 1;
constexpr std::uint16_t hardware_option = 2, application_option = 4;  // of the section
constexpr std::uint16_t name_option = 2, description_option = 3,
                        resolution_option = 9;  // of an interface
constexpr std::uint16_t flags_option = 2;       // of a packet
constexpr std::uint32_t inbound = 1, outbound = 2;

template <typename T>
void put(std::string& block, T value) {
  for (std::size_t i = 0; i < sizeof value; ++i) block += static_cast<char>(value >> (8 * i));
}

void put_big_endian(std::string& block, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) block += static_cast<char>(value >> shift);
}

void pad(std::string& block) { block.append((4 - block.size() % 4) % 4, '\0'); }

void put_option(std::string& block, std::uint16_t code, std::string_view value) {
  const std::string_view cut = value.substr(0, 0xFFFF);
  put(block, code);
  put(block, static_cast<std::uint16_t>(cut.size()));
  block += cut;
  pad(block);
}

void put_text(std::string& block, std::uint16_t code, std::string_view text) {
  if (!text.empty()) put_option(block, code, text);
}

/// Options end, and type and length stand around the body.
std::string finish(std::uint32_t type, std::string body) {
  put_option(body, end_of_options, {});
  const auto length = static_cast<std::uint32_t>(body.size() + 12);
  std::string block;
  put(block, type);
  put(block, length);
  block += body;
  put(block, length);
  return block;
}

std::string rtac(const PcapngPacket& packet) {
  std::string header;
  put_big_endian(header, static_cast<std::uint32_t>(packet.time / 1'000'000'000));
  put_big_endian(header, static_cast<std::uint32_t>(packet.time % 1'000'000'000 / 1000));
  header += packet.sent ? '\1' : '\2';  // DATA_TX_START, DATA_RX_START
  header.append(3, '\0');               // control lines, footer
  return header;
}

/// `header` goes before the bytes.
std::string enhanced(const PcapngPacket& packet, const std::string& header) {
  const std::size_t kept = std::min(packet.bytes.size(), largest_packet - header.size());
  std::string body;
  put(body, packet.interface);
  put(body, static_cast<std::uint32_t>(packet.time >> 32));
  put(body, static_cast<std::uint32_t>(packet.time));
  put(body, static_cast<std::uint32_t>(header.size() + kept));
  put(body, static_cast<std::uint32_t>(header.size() + packet.bytes.size() + packet.left_out));
  body += header;
  body.append(packet.bytes.begin(), packet.bytes.begin() + static_cast<std::ptrdiff_t>(kept));
  pad(body);
  put_text(body, comment_option, packet.comment);
  std::string flags;
  put(flags, packet.sent ? outbound : inbound);
  put_option(body, flags_option, flags);
  return finish(enhanced_packet, std::move(body));
}

}  // namespace

std::string pcapng_section(std::string_view application, std::string_view hardware) {
  std::string body;
  put(body, std::uint32_t{0x1A2B3C4D});
  put(body, std::uint16_t{1});
  put(body, std::uint16_t{0});
  put(body, ~std::uint64_t{0});  // its length is not known yet
  put_text(body, hardware_option, hardware);
  put_text(body, application_option, application);
  return finish(section_header, std::move(body));
}

std::string pcapng_interface(std::uint16_t linktype, std::string_view name,
                             std::string_view description) {
  std::string body;
  put(body, linktype);
  put(body, std::uint16_t{0});
  put(body, std::uint32_t{0});  // no limit to the length of a packet
  put_text(body, name_option, name);
  put_text(body, description_option, description);
  put_option(body, resolution_option, "\x09");
  return finish(interface_description, std::move(body));
}

std::string pcapng_packet(const PcapngPacket& packet) { return enhanced(packet, {}); }

std::string pcapng_serial_packet(const PcapngPacket& frame) { return enhanced(frame, rtac(frame)); }

}  // namespace fieldproof::reports
