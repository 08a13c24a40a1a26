#include "src/xgt_cnet/client.hpp"

#include <algorithm>

#include "src/base/letters.hpp"

namespace fieldproof {

namespace {
constexpr std::uint32_t first_result_word = 512, words_per_block = 6;  // of P2P parameter 1 in L
constexpr unsigned ndr_bit = 0, err_bit = 1;


DeviceAddress l_address(const PlcModel& model, char type, std::uint32_t index) {
  return {static_cast<std::uint8_t>(model.area('L') - model.areas.data()), type, false, index};
}

std::uint16_t error_of(const XgtFault& fault) {
  switch (fault.check) {
    case XgtCheck::none: return 0;
    case XgtCheck::head: return p2p_error::head;
    case XgtCheck::tail: return p2p_error::tail;
    case XgtCheck::bcc: return p2p_error::bcc;
    case XgtCheck::station: return p2p_error::station;
    case XgtCheck::command: return p2p_error::protocol;
    case XgtCheck::data: return p2p_error::not_hex;
    default: return p2p_error::length;
  }
}
}  // namespace

std::string unpadded_name(std::string_view name) {
  if (name.size() < 4 || name.find('.') != std::string_view::npos) return std::string(name);
  const std::size_t digit = std::min(name.find_first_not_of('0', 3), name.size() - 1);
  return std::string(name.substr(0, 3)) + std::string(name.substr(digit));
}

XgtClient::XgtClient(PlcMemory& memory, std::vector<P2pBlock> blocks, const Timing& timing, bool running)
    : memory_(memory),
      blocks_(std::move(blocks)),
      timing_(timing),
      running_(running),
      receiver_(FrameReceiver::Side::client, timing.gap),
      progress_(blocks_.size()) {}

void XgtClient::receive(const Burst& burst) {
  receiver_.receive(burst, *this);
  now_ = std::max(now_, burst.end());
}

std::optional<Time> XgtClient::wake_at() const {
  const auto gap = receiver_.wake_at();
  if (waiting_) return gap ? std::min(*gap, deadline_) : deadline_;
  return next_wanted() ? std::optional(now_) : gap;
}

Bytes XgtClient::advance(Time now) {
  now_ = std::max(now_, now);
  receiver_.advance(now_, *this);
  if (waiting_ && now_ >= deadline_) finish(noise_ ? p2p_error::head : p2p_error::time_out);
  if (waiting_ || !running_) return {};
  waiting_ = next_wanted();
  if (!waiting_) return {};
  progress_[*waiting_].wanted = false;
  receiver_.reset();
  noise_ = false;
  Bytes bytes = request_of(blocks_[*waiting_]);
  deadline_ = now_ + timing_.character_time * static_cast<Duration::rep>(bytes.size()) + timing_.time_out;
  return bytes;
}

void XgtClient::scan() {
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    const bool on = memory_.read(blocks_[i].flag) != 0;
    if (on && !progress_[i].flag_was_on && running_) progress_[i].wanted = true;
    progress_[i].flag_was_on = on;
  }
}

void XgtClient::set_running(bool running) {
  running_ = running;
  if (running) return;
  waiting_.reset();
  for (Progress& p : progress_) p.wanted = false;
}

void XgtClient::power_cycle() {
  counters_ = {};
  receiver_.reset();
  waiting_.reset();
  for (std::size_t i = 0; i < blocks_.size(); ++i) progress_[i] = {memory_.read(blocks_[i].flag) != 0, false};
}

std::optional<std::size_t> XgtClient::next_wanted() const {
  const auto next = std::ranges::find_if(progress_, &Progress::wanted);
  if (next == progress_.end()) return std::nullopt;
  return static_cast<std::size_t>(next - progress_.begin());
}

Bytes XgtClient::request_of(const P2pBlock& block) const {
  XgtRequest request{.station = block.station, .command = 'r', .kind = block.count == 1 ? "SS" : "SB", .blocks = 1};
  request.service = request.content = block.count == 1 ? XgtService::read_blocks : XgtService::read_run;
  request.block[0].name = block.read;
  request.count = block.count;
  Bytes bytes;
  encode_request(request, bytes);
  return bytes;
}

void XgtClient::on_frame(ByteView frame, Time) {
  if (!waiting_) return;
  const P2pBlock& block = blocks_[*waiting_];
  const XgtReply reply = parse_reply(frame);
  const std::uint16_t error = check(reply, block);
  if (error == 0) {
    const std::size_t digits = reply.data[0].size() / block.count;
    for (unsigned i = 0; i < block.count; ++i) {
      std::uint64_t value = 0;
      for (const char c : reply.data[0].substr(i * digits, digits)) value = value << 4 | static_cast<std::uint64_t>(hex_digit(c));
      memory_.write(block.save + i, value);
    }
  }
  finish(error);
}

std::uint16_t XgtClient::check(const XgtReply& reply, const P2pBlock& block) const {
  if (reply.fault.check <= XgtCheck::bcc) return error_of(reply.fault);
  if (reply.fault.check == XgtCheck::station || reply.station != block.station) return p2p_error::station;
  if (reply.fault) return error_of(reply.fault);
  const bool same_service = reply.command == 'r' && upper(reply.kind[1]) == (block.count == 1 ? 'S' : 'B');
  if (!same_service) return p2p_error::protocol;
  if (!reply.ack) return p2p_error::nak;
  const std::size_t digits = std::size_t{block.count} * type_bytes(block.save.type) * 2;
  return reply.blocks == 1 && reply.data[0].size() == digits ? 0 : p2p_error::length;
}

void XgtClient::on_broken_frame(std::uint16_t why) {
  if (!waiting_) return;
  if (why == service_status::head) noise_ = true;
  else finish(why);  // 2 and 3 mean the same in Appendix 3.3
}

void XgtClient::finish(std::uint16_t error) {
  const auto b = static_cast<std::uint32_t>(*waiting_);
  const std::uint32_t word = first_result_word + words_per_block * b;
  const PlcModel& model = memory_.model();
  memory_.write(l_address(model, 'X', word * 16 + ndr_bit), error == 0);
  memory_.write(l_address(model, 'X', word * 16 + err_bit), error != 0);
  memory_.write(l_address(model, 'W', word + 1), error);
  const DeviceAddress count = l_address(model, 'D', (word + (error == 0 ? 2 : 4)) / 2);
  memory_.write(count, memory_.read(count) + 1);
  if (error == 0) counters_.count_service();
  else counters_.count_error(error);
  waiting_.reset();
  scan();  // what was saved may be a flag
}

}  // namespace fieldproof
