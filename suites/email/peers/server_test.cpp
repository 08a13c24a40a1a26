// Mails of the emulated module, in a process of its own, to an SMTP server of Debian
// (python3-aiosmtpd), which knows nothing of us: what arrives is what was meant.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "suites/modbus/peers/test_ports.hpp"
#include "suites/tool/tool.hpp"

namespace fieldproof::email_peers {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using tool_tests::Process;

class Server {
 public:
  explicit Server(std::vector<std::string> more = {}) : process_(arguments(std::move(more))) {
    EXPECT_TRUE(process_.wait_for("listening"));
  }

  std::uint16_t port() const { return port_; }
  /// Its mails, as soon as there is one.
  std::vector<json> mails() {
    EXPECT_TRUE(process_.wait_for("}\n"));
    process_.signal(SIGTERM);
    const std::string out = process_.wait().out;
    std::vector<json> all;
    for (std::size_t at = 0, end = 0; (end = out.find('\n', at)) != std::string::npos; at = end + 1)
      if (out[at] == '{') all.push_back(json::parse(out.substr(at, end - at)));
    return all;
  }

 private:
  std::vector<std::string> arguments(std::vector<std::string> more) const {
    more.insert(more.begin(), {"/usr/bin/python3", "-B",
                               FIELDPROOF_SOURCE_DIR "/suites/email/peers/smtp_server.py",
                               std::to_string(port_)});
    return more;
  }

  std::uint16_t port_ = modbus_peers::free_port();
  Process process_;
};

json settings(std::uint16_t port) {
  json email = json::parse(R"({
    "user": "Hall 2.1", "address": "plc@plant.example", "server": "127.0.0.1",
    "addresses": [{"name": "Tony", "address": "tony@plant.example"},
                  {"name": "Peter", "address": "peter@plant.example"},
                  {"name": "Friend", "group": [0, 1]}],
    "messages": [{"title": "Pump 3", "parts": [{"text": "Pump 3 has stopped", "change": true},
                                               {"text": ".", "change": true},
                                               {"text": "bytes ", "change": false},
                                               {"mb": 3, "change": true},
                                               {"text": "end"}]}]})");
  email["port"] = port;
  return email;
}

/// A PLC that mails message 0 each second.
class MailingPlc {
 public:
  /// `more_blocks` ask a partner that is not there.
  MailingPlc(const std::string& protocol, std::uint16_t port, json more_blocks = json::array())
      : emulator_(arguments(protocol, port, std::move(more_blocks))) {}

  Process& process() { return emulator_; }

 private:
  std::vector<std::string> arguments(const std::string& protocol, std::uint16_t port,
                                     json blocks) const {
    blocks.push_back(
        {{"function", "esend"}, {"flag", "F93"}, {"message", 0}, {"to", 2}, {"data", "%MB100"}});
    const json p2p{{"partner", "127.0.0.1"},
                   {"port", modbus_peers::free_port()},
                   {"email", settings(port)},
                   {"blocks", blocks}};
    return {FIELDPROOF_TOOL,
            "emulate",
            "xbc-h?protocol=" + protocol,
            "--p2p",
            folder_.write("p2p.json", json{{"p2p", p2p}}.dump()),
            "-v"};
  }

  tool_tests::TestFolder folder_;
  Process emulator_;
};

json expected() {
  return {{"host", "plant.example"},
          {"sender", "plc@plant.example"},
          {"recipients", {"tony@plant.example", "peter@plant.example"}},
          {"from", "\"Hall 2.1\" <plc@plant.example>"},
          {"reply_to", "plc@plant.example"},
          {"to", "Tony <tony@plant.example>,\r\n Peter <peter@plant.example>"},
          {"subject", "Pump 3"},
          {"text", "Pump 3 has stopped\r\n.\r\nbytes ...\r\nend\r\n"}};
}

TEST(SmtpServer, TakesWhatTheModuleMails) {
  Server server;
  MailingPlc plc("email", server.port());
  EXPECT_TRUE(plc.process().wait_for("221"));
  const std::vector<json> mails = server.mails();
  ASSERT_FALSE(mails.empty());
  EXPECT_EQ(mails.front(), expected());
}

TEST(SmtpServer, TakesMailsBesideTheChannelsOfAnXgtModule) {
  Server server;
  const json read{{"flag", "F92"}, {"read", "%MW100"}, {"save", "%MW200"}, {"channel", 2}};
  for (const char* protocol : {"xgt-fenet", "modbus-tcp"}) {
    json block = read;
    if (std::string_view(protocol) == "modbus-tcp") block["read"] = "0x40001";
    MailingPlc plc(protocol, server.port(), json::array({block}));
    EXPECT_TRUE(plc.process().wait_for("221 ")) << protocol;
  }
  EXPECT_EQ(server.mails().front(), expected());
}

TEST(SmtpServer, ThatRefusesAMemberHasTheMailForTheOther) {
  Server server({"--refuse", "tony@plant.example"});
  MailingPlc plc("email", server.port());
  EXPECT_TRUE(plc.process().wait_for("550 no such mailbox"));
  const std::vector<json> mails = server.mails();
  ASSERT_FALSE(mails.empty());
  EXPECT_EQ(mails.front().at("recipients"), json({"peter@plant.example"}));
}

TEST(SmtpServer, ThatIsNotThereIsTriedAgainAtTheNextEdge) {
  MailingPlc plc("email", modbus_peers::free_port());
  EXPECT_TRUE(plc.process().wait_for("own 2"));
}

TEST(EmailFile, ErrorsNameFileAndKey) {
  const tool_tests::TestFolder folder;
  const auto refused = [&folder](const char* list, const json& entry, const json& block) {
    json email = settings(25);
    email[list].push_back(entry);
    const json p2p{{"email", email}, {"blocks", json::array({block})}};
    const tool_tests::Finished tool =
        tool_tests::run_tool({"emulate", "xbc-h?protocol=xgt-fenet", "--p2p",
                              folder.write("p2p.json", json{{"p2p", p2p}}.dump())});
    EXPECT_EQ(tool.code, 2);
    EXPECT_THAT(tool.err, HasSubstr(folder / "p2p.json"));
    return tool.err;
  };
  const json mails{
      {"function", "esend"}, {"flag", "%MX0"}, {"message", 0}, {"to", 7}, {"data", "%MB0"}};
  const json good{{"address", "ann@plant.example"}};
  EXPECT_THAT(refused("addresses", good, mails),
              HasSubstr("as xgt-fenet (MODEL?protocol=... for another): cannot set up P2P block 0: "
                        "to is 7, and p2p.email.addresses has none of that number; it has 0, 1, 2, "
                        "3"));
  EXPECT_THAT(refused("addresses", {{"group", {0, 1, 8}}}, mails),
              HasSubstr("cannot read p2p.email.addresses[3]: group has 8, and there is no such "
                        "address"));
  EXPECT_THAT(refused("messages", {{"titel", "x"}}, mails),
              HasSubstr("cannot read p2p.email.messages[1]: there is no key 'titel'"));
}

}  // namespace
}  // namespace fieldproof::email_peers
