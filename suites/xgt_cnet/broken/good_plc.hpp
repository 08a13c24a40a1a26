// The good PLC behind a fault, and frames as text that faults edit.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "src/base/result.hpp"
#include "src/plc/address.hpp"
#include "src/xgt_cnet/codec.hpp"
#include "src/xgt_cnet/plc.hpp"
#include "suites/broken/good_device.hpp"

namespace fieldproof::xgt_cnet_broken {

class GoodPlc : public broken::GoodDevice {
 public:
  GoodPlc(std::unique_ptr<plc::Plc> plc, const plc::PlcModel& model, unsigned station)
      : broken::GoodDevice(std::move(plc)), model_(&model), station_(station) {}

  /// What the name means on this model.
  plc::ParsedAddress address(std::string_view name) const {
    return plc::parse_address(*model_, name);
  }
  const plc::PlcModel& model() const { return *model_; }
  unsigned station() const { return station_; }

 private:
  const plc::PlcModel* model_;
  unsigned station_;
};

/// A frame taken apart: what a fault edits as text.
struct FrameText {
  char head = 0;
  std::string body;  // station, command, type or number, content
  char tail = 0;
  std::string check;  // BCC; empty without

  char command() const { return body.size() > 2 ? body[2] : '\0'; }
  bool lower_case() const { return command() >= 'a' && command() <= 'z'; }
  /// Station, command and type or number; what follows.
  std::string front() const { return body.substr(0, 5); }
  std::string content() const { return body.size() > 5 ? body.substr(5) : std::string(); }
  bool is_ack() const { return head == static_cast<char>(xgt_cnet::xgt_ack); }
  bool is_nak() const { return head == static_cast<char>(xgt_cnet::xgt_nak); }
  /// "RSS": the command and its type in upper case.
  std::string service() const;

  std::string without_check() const { return head + body + tail; }
  /// The right BCC where the frame has one.
  void seal();
  /// Nothing where there is no header.
  Bytes bytes() const { return head == 0 ? Bytes{} : to_bytes(without_check() + check); }
};

/// A frame with a tail; a request ends with EOT, a reply with ETX.
FrameText take_apart(ByteView frame);

/// The low byte of the sum, as two upper-case hex digits.
std::string sum_of(std::string_view text);

Bytes ack_to(const xgt_cnet::XgtRequest& request, std::string_view content = {});
Bytes nak_to(const xgt_cnet::XgtRequest& request, std::uint16_t code);

/// The error code of a NAK; nothing for other replies.
std::optional<unsigned> refusal(ByteView reply);

/// "%MW", and 100 of "%MW100"; no number where it is no decimal one.
struct NameParts {
  std::string area_and_type;
  std::optional<std::uint32_t> number;
};
NameParts split_name(std::string_view name);

/// The same request with other names; requests that cannot be read stay as they are.
template <typename Rename>
Bytes with_names(const Bytes& frame, Rename rename) {
  xgt_cnet::XgtRequest request = xgt_cnet::parse_request(frame);
  if (request.fault || request.blocks == 0) return frame;
  std::array<std::string, xgt_cnet::xgt_max_blocks> names;
  for (unsigned i = 0; i < request.blocks; ++i) {
    names[i] = rename(std::string(request.block[i].name));
    request.block[i].name = names[i];
  }
  Bytes out;
  xgt_cnet::encode_request(request, out);
  return out;
}

}  // namespace fieldproof::xgt_cnet_broken
