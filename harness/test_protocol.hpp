// A protocol as small as can be, for tests of the harness: '<' body '>' frames, stations as two hex
// digits.
#pragma once

#include <algorithm>
#include <nlohmann/json.hpp>

#include "harness/protocol.hpp"

namespace fieldproof::harness {

struct TestProtocol : Protocol, public Probing, public MemoryRequests, public Tables {
  std::string_view name() const override { return "xgt-cnet"; }
  std::vector<std::string> models() const override { return {"test"}; }
  Result<std::unique_ptr<plc::EmulatedDevice>> make_device(std::string_view,
                                                           const nlohmann::json&) const override {
    return fail("no device");
  }
  notation::NameHead name_head() const override {
    return [](std::size_t characters) { return to_bytes(hex_number(characters, 2)); };
  }
  Bytes station_bytes(int station) const override {
    return to_bytes(hex_number(static_cast<unsigned>(station), 2));
  }

  std::optional<std::size_t> frame_length(ByteView bytes) const override {
    const auto tail = std::ranges::find(bytes, Byte{'>'});
    if (tail == bytes.end()) return std::nullopt;
    return static_cast<std::size_t>(tail - bytes.begin()) + 1;
  }
  std::vector<Field> explain(ByteView frame) const override {
    std::vector<Field> fields;
    for (std::size_t i = 0; i < frame.size(); ++i)
      fields.push_back({"byte " + std::to_string(i), i, 1, to_text(frame.subspan(i, 1)), ""});
    return fields;
  }

  bool reply_repeats(ByteView request) const override {
    return to_text(request).starts_with("<write");
  }

  const Probing* probing() const override { return this; }
  const MemoryRequests* memory() const override { return this; }
  const Tables* tables() const override { return this; }

  Bytes probing_request(int, ByteView) const override { return to_bytes("<probe>"); }
  bool answers_probe(ByteView, ByteView reply) const override {
    return to_text(reply) == "<alive>";
  }

  Result<std::vector<Bytes>> requests_to_write(int, std::string_view address,
                                               std::string_view hex) const override {
    return std::vector<Bytes>{to_bytes("<w" + std::string(address) + "=" + std::string(hex) + ">")};
  }
  Result<std::vector<Bytes>> requests_to_read(int, std::string_view address,
                                              std::size_t) const override {
    return std::vector<Bytes>{to_bytes("<r" + std::string(address) + ">")};
  }
  Status acknowledged(ByteView reply) const override {
    return to_text(reply) == "<ok>" ? ok() : Status(fail("not <ok>"));
  }
  Result<std::string> digits_in(ByteView reply) const override {
    if (reply.size() < 3) return fail("no value");
    return to_text(reply.subspan(1, reply.size() - 2));
  }
  bool answers(ByteView, ByteView) const override { return true; }

  std::vector<Written> written_by(ByteView request) const override {
    if (request.size() < 2 || request[1] != 'w') return {};
    return {{"M", 1, 1, "%MW1"}};
  }

  /// Words alone, "%MW1", and as many behind it as there are digits.
  std::optional<Written> named(std::string_view address, std::size_t digits) const override {
    if (address.size() < 4 || address[0] != '%' || address[2] != 'W') return std::nullopt;
    const auto word = static_cast<std::uint32_t>(std::stoul(std::string(address.substr(3))));
    return Written{std::string(address.substr(1, 1)), word,
                   word + static_cast<std::uint32_t>(digits / 4) - 1, std::string(address)};
  }

  std::vector<std::string_view> output_areas() const override { return {"P", "Q"}; }
  Status check_table(const nlohmann::json&) const override { return ok(); }
};

}  // namespace fieldproof::harness
