#include "src/p2p/client.hpp"

#include <algorithm>
#include <bit>

namespace fieldproof::p2p {

namespace {
/// Appendix 3.3 for what is no frame.
std::uint16_t error_of(std::uint16_t status) {
  return status == plc::service_status::not_modbus ? p2p_error::bcc : status;
}

/// Cnet EN 11.1.4 'P2P service'.
std::uint16_t service_code(std::uint16_t error) {
  constexpr std::uint16_t time_out = 5, no_such_request = 0xFFFE;
  if (error == p2p_error::time_out) return time_out;
  return error == p2p_error::send ? no_such_request : error;
}
}  // namespace

P2pClient::P2pClient(plc::PlcMemory& memory, const P2pParameters& parameters, unsigned channel,
                     std::unique_ptr<P2pDriver> driver, const Timing& timing,
                     std::function<void()> saved)
    : memory_(memory),
      driver_(std::move(driver)),
      timing_(timing),
      saved_(std::move(saved)),
      link_(parameters.link) {
  for (const P2pBlock& block : parameters.blocks) {
    if (block.channel != channel) continue;
    const BlockSet bit = BlockSet{1} << blocks_.size();
    blocks_.push_back(block);
    results_.push_back(p2p_result_flags(memory.model(), parameters.parameter, block.number));
    if (block.function == P2pBlock::Function::receive) receivers_ |= bit;
    if (block.condition.period == Duration::zero()) continue;
    auto clock = std::ranges::find(clocks_, block.condition.period, &Clock::period);
    if (clock == clocks_.end()) clock = clocks_.insert(clock, Clock{block.condition.period});
    clock->blocks |= bit;
  }
}

void P2pClient::receive(const Burst& burst) {
  driver_->receive(burst, *this);
  now_ = std::max(now_, burst.end());
  heard_until_ = std::max(heard_until_, burst.end());
}

std::optional<Time> P2pClient::wake_at() const {
  if (!clocks_run_ && !clocks_.empty()) return now_;
  std::optional<Time> wake = driver_->wake_at();
  const auto earlier = [&wake](Time at) { wake = wake ? std::min(*wake, at) : at; };
  for (const Clock& clock : clocks_) earlier(clock.next);
  if (busy_)
    earlier(deadline_);
  else if ((wanted_ | round_) != 0)
    earlier(std::max(now_, free_at()));
  return wake;
}

Bytes P2pClient::advance(Time now) {
  now_ = std::max(now_, now);
  if (!clocks_run_) start_clocks();
  driver_->advance(now_, *this);
  if (busy_ && now_ >= deadline_) {
    const std::uint16_t late = noise_ ? p2p_error::head : p2p_error::time_out;
    const bool timed_out = awaits_reply_;
    finish(*busy_, timed_out ? late : p2p_error::none);
    if (timed_out && end_connection_) end_connection_();
  }
  tick();
  while (!busy_ && now_ >= free_at()) {
    const auto next = take_next();
    if (!next) break;
    if (Bytes bytes = request(*next); !bytes.empty()) return bytes;
  }
  return {};
}

void P2pClient::start_clocks() {
  for (Clock& clock : clocks_) clock.next = now_ + clock.period;
  clocks_run_ = true;
}

void P2pClient::tick() {
  for (Clock& clock : clocks_) {
    if (now_ < clock.next) continue;
    fire(clock.blocks);
    clock.next += clock.period * ((now_ - clock.next) / clock.period + 1);
  }
}

void P2pClient::scan() {
  BlockSet on = 0;
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    const auto& flag = blocks_[i].condition.flag;
    if (flag && memory_.read(*flag) != 0) on |= BlockSet{1} << i;
  }
  fire(on & ~flags_on_);
  flags_on_ = on;
}

void P2pClient::fire(BlockSet blocks) {
  if (!active_) return;
  if (busy_) blocks &= ~(BlockSet{1} << *busy_);
  wanted_ |= blocks & ~round_;
}

std::optional<std::size_t> P2pClient::take_next() {
  if (round_ == 0) round_ = std::exchange(wanted_, 0);
  if (round_ == 0) return std::nullopt;
  const auto next = static_cast<std::size_t>(std::countr_zero(round_));
  round_ &= round_ - 1;
  return next;
}

/// Empty: it cannot be sent.
Bytes P2pClient::request(std::size_t block) {
  Result<Bytes> bytes = driver_->request(blocks_[block], memory_);
  if (!bytes || bytes->empty()) {
    finish(block, p2p_error::send);
    return {};
  }
  busy_ = block;
  noise_ = false;
  awaits_reply_ = driver_->awaits_reply(blocks_[block]);
  if (awaits_reply_ && !end_connection_) driver_->reset();
  const Time sent = now_ + timing_.character_time * static_cast<Duration::rep>(bytes->size());
  heard_until_ = sent;
  deadline_ = awaits_reply_ ? sent + timing_.time_out : sent;
  return std::move(*bytes);
}

void P2pClient::set_active(bool active) {
  // What was half received is lost; of a connection, the rest of the frame still comes.
  if (active != active_ && !end_connection_) driver_->reset();
  active_ = active;
  if (active) return;
  busy_.reset();
  wanted_ = round_ = 0;
}

void P2pClient::set_run(bool run) {
  run_ = run;
  set_active(run_ && link_);
}

std::optional<Status> P2pClient::act(std::string_view action) {
  if (action != "link on" && action != "link off") return std::nullopt;
  link_ = action == "link on";
  set_active(run_ && link_);
  return ok();
}

void P2pClient::connection_lost() {
  if (busy_) finish(*busy_, p2p_error::send);
}

void P2pClient::power_cycle() {
  counters_ = {};
  driver_->reset();
  busy_.reset();
  wanted_ = round_ = 0;
  clocks_run_ = false;
}

void P2pClient::on_frame(ByteView frame, Time) {
  if (busy_ && awaits_reply_) {
    if (const auto error = driver_->take(blocks_[*busy_], frame, memory_))
      return finish(*busy_, *error);
  }
  if (!active_) return;
  for (BlockSet left = receivers_; left != 0; left &= left - 1) {
    const auto block = static_cast<std::size_t>(std::countr_zero(left));
    if (const auto error = driver_->take(blocks_[block], frame, memory_))
      return finish(block, *error);
  }
}

void P2pClient::on_broken_frame(std::uint16_t why) {
  if (end_connection_) end_connection_();
  if (!busy_ || !awaits_reply_) return;
  if (why == plc::service_status::head)
    noise_ = true;
  else
    finish(*busy_, error_of(why));
}

void P2pClient::finish(std::size_t block, std::uint16_t error) {
  const P2pResultFlags& result = results_[block];
  memory_.write(result.ndr, error == p2p_error::none);
  memory_.write(result.err, error != p2p_error::none);
  memory_.write(result.status, error);
  const plc::DeviceAddress& count = error == p2p_error::none ? result.services : result.errors;
  memory_.write(count, memory_.read(count) + 1);  // a dword: it wraps
  if (error == p2p_error::none)
    counters_.count_service();
  else
    counters_.count_error(service_code(error));
  if (busy_ == block) busy_.reset();
  if (saved_) saved_();
}

}  // namespace fieldproof::p2p
