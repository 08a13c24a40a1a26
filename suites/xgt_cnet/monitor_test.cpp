// The frame monitor on an XGT channel, and the phenomenon of Cnet EN 11.2.4.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

#include "harness/monitored_device.hpp"
#include "src/line/faults.hpp"
#include "suites/xgt_cnet/protocol.hpp"

namespace fieldproof::xgt_cnet_suite {
namespace {

using nlohmann::json;

constexpr Duration character = 1041667ns;  // 9600-8N1

std::unique_ptr<plc::EmulatedDevice> make(const json& config,
                                          const plc::FrameMonitor::Record& record = {}) {
  auto made = harness::make_monitored_device(protocol(), "xbc-h", config, record);
  if (!made) throw std::runtime_error(made.error().message);
  return std::move(*made);
}

/// Two devices on a full duplex line, until nothing happens before `until`.
void connect(line::Device& a, line::Device& b, Time until) {
  for (;;) {
    line::Device* next = nullptr;
    for (line::Device* one : {&a, &b})
      if (one->wake_at() && (!next || *one->wake_at() < *next->wake_at())) next = one;
    if (!next || *next->wake_at() > until) return;
    const Time now = *next->wake_at();
    if (const Bytes bytes = next->advance(now); !bytes.empty())
      (next == &a ? b : a).receive({bytes, now, character});
  }
}

/// What a client that reads one word monitors, where its partner's line has these faults.
std::vector<std::string> monitored(const line::LineFaults& faults,
                                   json partner = {{"station", 1}}) {
  std::vector<std::string> seen;
  const auto client =
      make({{"station", 0},
            {"role", "client"},
            {"p2p",
             {{"blocks",
               {{{"flag", "%MX00000"}, {"read", "%MW0"}, {"save", "%MW200"}, {"station", 1}}}}}}},
           [&](const plc::MonitoredFrame& frame) {
             seen.push_back((frame.sent ? "Transmission " : "Reception ") +
                            std::string(frame.result.text) + ' ' + plc::ascii_view(frame));
           });
  const auto server = make(partner);
  line::FaultyDevice line(*server->line(), faults, character);
  connect(*client->line(), line, 10ms);
  if (!client->set("%MX00000", "01")) throw std::runtime_error("no flag");
  connect(*client->line(), line, 2s);
  return seen;
}

TEST(XgtMonitor, ShowsRequestAndReply) {
  EXPECT_EQ(monitored({}),
            (std::vector<std::string>{"Transmission XGT client [ENQ]01rSS0104%MW0[EOT]40",
                                      "Reception XGT client [ACK]01rSS01020000[ETX]05"}));
}

TEST(XgtMonitor, TheEchoOfAClientIsUnknown) {
  line::LineFaults wired_as_485;
  wired_as_485.echo = true;
  EXPECT_EQ(monitored(wired_as_485),
            (std::vector<std::string>{"Transmission XGT client [ENQ]01rSS0104%MW0[EOT]40",
                                      "Reception Unknown [ENQ]01rSS0104%MW0[EOT]40",
                                      "Reception XGT client [ACK]01rSS01020000[ETX]05"}));
}

TEST(XgtMonitor, ADamagedReplyIsUnknown) {
  line::LineFaults faults;
  faults.reply.flip = 5;
  EXPECT_EQ(monitored(faults).back(), "Reception Unknown [ACK]01rSR01020000[ETX]05");
}

TEST(XgtMonitor, AServerKnowsRequests) {
  const auto server = make({{"station", 1}, {"monitor", true}});
  EXPECT_EQ(*server->get("@monitor", 2), "00");
  server->line()->receive({to_bytes("\x05"
                                    "01rSS0104%MW0\x04"
                                    "40"),
                           {},
                           character});
  EXPECT_EQ(*server->get("@monitor", 2), "01");
  server->line()->receive({to_bytes("\x06"
                                    "01rSS01020000\x03"
                                    "05"),
                           100ms, character});
  EXPECT_EQ(*server->get("@monitor", 2), "06") << "the reply of another station";
  EXPECT_FALSE(make({{"station", 1}})->get("@monitor", 2)) << "only where it is asked for";
}

}  // namespace
}  // namespace fieldproof::xgt_cnet_suite
