// Faults of time and of the line: where frames begin and end, late, repeated, lost and surplus
// bytes (Cnet EN 9.3.1, 9.3.2).
#include <algorithm>
#include <utility>

#include "suites/modbus/broken/faults.hpp"

namespace fieldproof::modbus_broken {

using broken::Sendings;
using modbus::ModbusReceiver;
using plc::FrameSink;

namespace {

Bytes operator+(Bytes a, const Bytes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// Frames end by the length that their function code tells, not by silence: what is cut short waits
/// for more.
class ByLength : public ModbusReceiver {
 public:
  void receive(const Burst& burst, FrameSink& sink) override {
    heard_.insert(heard_.end(), burst.bytes.begin(), burst.bytes.end());
    while (heard_.size() >= length()) {
      const Bytes frame(heard_.begin(), heard_.begin() + static_cast<std::ptrdiff_t>(length()));
      heard_.erase(heard_.begin(), heard_.begin() + static_cast<std::ptrdiff_t>(length()));
      sink.on_frame(frame, burst.end());
    }
  }
  std::optional<Time> wake_at() const override { return std::nullopt; }
  void advance(Time, FrameSink&) override {}
  void reset() override { heard_.clear(); }

 private:
  std::size_t length() const {
    const bool many = function_of(heard_) == 0x0F || function_of(heard_) == 0x10;
    return many && heard_.size() > 6 ? 9u + heard_[6] : 8u;
  }

  Bytes heard_;
};

Behaviour end_by_length() {
  Behaviour behaviour;
  behaviour.receiver = [](modbus::ModbusMode, Duration) {
    return std::unique_ptr<ModbusReceiver>(new ByLength);
  };
  return behaviour;
}

/// An ASCII receiver that takes time at another speed: a second lasts `times` as long.
class OtherClock : public ModbusReceiver, private FrameSink {
 public:
  OtherClock(std::unique_ptr<ModbusReceiver> receiver, double times)
      : receiver_(std::move(receiver)), times_(times) {}

  void receive(const Burst& burst, FrameSink& sink) override {
    Burst other = burst;
    other.start = slowed(burst.start);
    sink_ = &sink;
    real_end_ = burst.end();
    receiver_->receive(other, *this);
  }
  std::optional<Time> wake_at() const override { return std::nullopt; }
  void advance(Time, FrameSink&) override {}
  void reset() override { receiver_->reset(); }

 private:
  Time slowed(Time time) const {
    return Time(static_cast<Time::rep>(static_cast<double>(time.count()) / times_));
  }
  void on_frame(ByteView frame, Time) override { sink_->on_frame(frame, real_end_); }
  void on_broken_frame(std::uint16_t why) override { sink_->on_broken_frame(why); }

  std::unique_ptr<ModbusReceiver> receiver_;
  double times_;
  FrameSink* sink_ = nullptr;
  Time real_end_{};
};

MakeBehaviour ascii_second_lasts(double times) {
  return [times] {
    Behaviour behaviour;
    behaviour.receiver = [times](modbus::ModbusMode mode, Duration gap) {
      return std::unique_ptr<ModbusReceiver>(
          new OtherClock(modbus::make_modbus_receiver(mode, gap), times));
    };
    return behaviour;
  };
}

MakeBehaviour hears(void (*hear)(Bytes& bytes)) {
  return [hear] {
    Behaviour behaviour;
    behaviour.hear = hear;
    return behaviour;
  };
}

/// A colon inside a frame is one more character of it. A new burst begins a new frame.
void no_restart_at_colon(Bytes& bytes) {
  bool inside = false;
  for (Byte& b : bytes) {
    if (b == ':' && inside) b = '?';
    inside = b == ':' || (inside && b != '\n');
  }
}

/// CR alone ends a frame.
void lf_for_cr(Bytes& bytes) {
  Bytes heard;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    heard.push_back(bytes[i]);
    if (bytes[i] == '\r' && (i + 1 == bytes.size() || bytes[i + 1] != '\n')) heard.push_back('\n');
  }
  bytes = heard;
}

Sendings in_halves(const Bytes&, Bytes reply) {
  const auto middle = reply.begin() + static_cast<std::ptrdiff_t>(reply.size() / 2);
  return {{Bytes(reply.begin(), middle)}, {Bytes(middle, reply.end()), 200ms}};
}

/// Silent for ever after a frame with a wrong check.
Behaviour die_of_a_wrong_check() {
  Behaviour behaviour;
  behaviour.answer = [dead = false](const Bytes& frame, GoodModbus& plc) mutable {
    dead = dead || plc.message(frame).empty();
    return dead ? Sendings{} : Sendings{{plc.answer(frame)}};
  };
  return behaviour;
}

/// After an exception one request is lost.
Behaviour deaf_after_exception() {
  Behaviour behaviour;
  behaviour.answer = [deaf = false](const Bytes& frame, GoodModbus& plc) mutable {
    Bytes reply = plc.answer(frame);
    if (std::exchange(deaf, false)) return Sendings{};
    deaf = exception_of(plc.message(reply)) != 0;
    return Sendings{{std::move(reply)}};
  };
  return behaviour;
}

/// The reply of the request before.
Behaviour one_behind() {
  Behaviour behaviour;
  behaviour.answer = [last = Bytes()](const Bytes& frame, GoodModbus& plc) mutable {
    Bytes reply = plc.answer(frame);
    std::swap(reply, last);
    return Sendings{{reply.empty() ? last : std::move(reply)}};
  };
  return behaviour;
}

}  // namespace

std::vector<Fault> line_faults() {
  return {
      {"ends_by_length", "a frame that is cut short waits for the bytes of the next one",
       end_by_length, "modbus_rtu/line/cut_after_3", "no answer"},
      {"ascii_second_ignored", "a silence of more than a second does not end an ASCII frame",
       ascii_second_lasts(10), "modbus_ascii/line/pause_too_long_station", "silence"},
      {"ascii_second_too_short", "a silence of half a second ends an ASCII frame",
       ascii_second_lasts(0.5), "modbus_ascii/line/pause_station", "no answer"},
      {"no_restart_at_colon", "a colon inside a frame does not begin a new one",
       hears(no_restart_at_colon), "modbus_ascii/line/colon_restarts", "no answer"},
      {"cr_alone_ends", "CR without LF ends a request", hears(lf_for_cr), "modbus_ascii/line/no_lf",
       "silence"},
      {"late_answer", "replies come after 700 ms", send_with([](const Bytes&, Bytes reply) {
         return Sendings{{std::move(reply), 700ms}};
       }),
       "modbus_rtu/modes/ten_in_a_row", ""},
      {"split_answer", "replies pause for 200 ms in the middle", send_with(in_halves),
       "modbus_rtu/modes/serves", "split answer"},
      {"echo", "the request comes back before an exception",
       send_with([](const Bytes& frame, Bytes reply) {
         return Sendings{{exception_of(reply) ? frame + reply : std::move(reply)}};
       }),
       "modbus_rtu/modes/normal_and_abnormal", "echo"},
      {"reply_twice", "each reply is sent twice",
       send_with([](const Bytes&, Bytes reply) { return Sendings{{reply + reply}}; }),
       "modbus_ascii/modes/serves", "after the complete"},
      {"trailing_byte", "a byte 00 follows each reply",
       send_with([](const Bytes&, Bytes reply) { return Sendings{{reply + Bytes{0}}}; }),
       "modbus_rtu/modes/serves", "after the complete"},
      {"noise_before_reply", "a byte FF comes before each reply",
       send_with([](const Bytes&, Bytes reply) { return Sendings{{Bytes{0xFF} + reply}}; }),
       "modbus_ascii/examples/read_coil_status_refused", "foreign"},
      {"reply_one_behind", "each reply is that to the request before", one_behind,
       "modbus_rtu/modes/serves", ""},
      {"dies_of_a_wrong_check", "silent for ever after a wrong CRC or LRC", die_of_a_wrong_check,
       "modbus_rtu/line/wrong_check/f03", "no answer", broken::alone},
      {"deaf_after_exception", "the request after an exception is not answered",
       deaf_after_exception, "modbus_rtu/exceptions/address_read/f03/affff", "no answer",
       broken::alone},
  };
}

}  // namespace fieldproof::modbus_broken
