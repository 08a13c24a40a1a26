// Bad input and bad devices: the right exit code, a message that names the culprit, reports, and an
// end in bounded time.
#include <gmock/gmock.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <memory>

#include "harness/system/pty_pair.hpp"
#include "harness/system/sockets/test_sockets.hpp"
#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {
namespace {

using nlohmann::ordered_json;
using testing::AllOf;
using testing::HasSubstr;

ordered_json first_step(ordered_json vector, const char* key, const ordered_json& value) {
  vector["steps"][0][key] = value;
  return vector;
}

ordered_json without(ordered_json vector, const char* key) {
  vector.erase(key);
  return vector;
}

std::string text_of(const ordered_json& vector) { return ordered_json::array({vector}).dump(1); }

// ---- start-up files and options

struct BadInput {
  const char* name;
  std::string file;  // written to FOLDER/`path`
  std::string path;
  std::vector<std::string> arguments;  // FOLDER stands for the folder of the test
  int code;
  std::vector<std::string> message;  // all of this stands in the one message
};

/// A vectors file of this text.
BadInput bad_vectors(const char* name, const std::string& text, std::vector<std::string> message) {
  message.push_back("xgt_cnet/test.json");
  return {name,
          text,
          "vectors/xgt_cnet/test.json",
          {"--vectors", "FOLDER/vectors"},
          2,
          std::move(message)};
}

BadInput bad_option(const char* name, std::vector<std::string> arguments,
                    std::vector<std::string> message, int code = 2) {
  return {name, "", "unused", std::move(arguments), code, std::move(message)};
}

BadInput bad_waivers(const char* name, const std::string& text, std::vector<std::string> message) {
  return {name, text, "waivers.json", {"--waivers", "FOLDER/waivers.json"}, 2, std::move(message)};
}

BadInput bad_profile(const char* name, const std::string& text, std::vector<std::string> message) {
  message.push_back("profile.json");
  return {name, text, "profile.json", {"--profile", "FOLDER/profile.json"}, 2, std::move(message)};
}

void PrintTo(const BadInput& input, std::ostream* out) { *out << input.name; }

std::vector<BadInput> bad_inputs() {
  const ordered_json good = small_vector("bad/one");
  return {
      bad_vectors("malformed_json", "[{\"id\": \"xgt_cnet/bad/one\",\n \"rev\" 1}]",
                  {"line 2, column 8: there is a number where ':' is due"}),
      bad_vectors(
          "comma_too_many", "[{\"id\": \"xgt_cnet/bad/one\",\n \"rev\": 1,}]",
          {"1 problem in the vectors",
           "line 2, column 11: there is '}' where a text in quotes is due; is there a comma "
           "too many before it?"}),
      bad_vectors("level_of_no_such_name", text_of(with(good, "level", "musst")),
                  {"'musst' is none of must, should, info; did you mean 'must'?"}),
      bad_vectors("not_utf8", "[{\"id\": \"\xFF\"}]", {"UTF-8"}),
      bad_vectors("unknown_key", text_of(first_step(good, "expekt", "ACK")),
                  {"xgt_cnet/bad/one", "expekt"}),
      bad_vectors("missing_title", R"([{"id": "xgt_cnet/bad/one", "rev": 1}])",
                  {"xgt_cnet/bad/one", "title"}),
      bad_vectors("wrong_type", R"([{"id": "xgt_cnet/bad/one", "rev": "first"}])",
                  {"xgt_cnet/bad/one", "rev"}),
      bad_vectors("bad_notation", text_of(first_step(good, "send", "[ENQ st 'rSS' FOO EOT BCC]")),
                  {"xgt_cnet/bad/one", "steps[0]", "FOO"}),
      bad_vectors("wire_that_contradicts_its_notation", text_of(first_step(good, "wire", "05 30")),
                  {"xgt_cnet/bad/one", "steps[0]", "wire and notation differ at byte 2"}),
      bad_vectors("rests_on_nothing", text_of(without(without(good, "statement"), "source")),
                  {"xgt_cnet/bad/one", "name a \"statement\" of a manual"}),
      bad_vectors("statement_that_is_not_there", text_of(without(good, "source")),
                  {"xgt_cnet/bad/one", "no statement 'm/1'"}),
      bad_vectors("open_bracket", text_of(first_step(good, "send", "[ENQ st 'rSS' EOT BCC")),
                  {"xgt_cnet/bad/one", "steps[0]"}),
      bad_vectors("two_kinds_in_a_step", text_of(first_step(good, "silence", true)),
                  {"xgt_cnet/bad/one", "steps[0]", "this one has 2"}),
      bad_vectors("unknown_parameter",
                  text_of(first_step(good, "send", "[ENQ st '${r}SS' EOT BCC]")),
                  {"xgt_cnet/bad/one", "${r}"}),
      bad_vectors("duplicate_id", ordered_json::array({good, good}).dump(),
                  {"xgt_cnet/bad/one", "twice"}),
      bad_vectors("close_of_a_line",
                  text_of(with(good, "steps",
                               ordered_json::array({{{"expect_close", "fin"}, {"within", "1s"}}}))),
                  {"xgt_cnet/bad/one", "steps[0]", "serial line", "take \"expect_close\" out"}),
      bad_vectors(
          "link_that_is_not_open",
          text_of(with(good, "steps",
                       ordered_json::array({{{"open", {{"name", "a"}, {"protocol", "xgt-cnet"}}}},
                                            {{"send", ask_word}, {"on", "b"}}}))),
          {"xgt_cnet/bad/one", "steps[1]", "no link 'b' is open; open: 'a'"}),
      bad_vectors(
          "pause_in_a_datagram",
          text_of(with(with(good, "id", "modbus_tcp/bad/one"), "steps",
                       ordered_json::array({{{"open", {{"name", "a"}, {"transport", "udp"}}}},
                                            {{"send", "[01 ~20ms 02]"}}}))),
          {"modbus_tcp/bad/one", "steps[1]", "carries datagrams", "take the pause (~) out"}),
      bad_option("port_out_of_range", {"--endpoint", "tcp:127.0.0.1:65536"},
                 {"'65536' is no port", "write a number up to 65535"}),
      bad_option("port_zero", {"--endpoint", "tcp:127.0.0.1:0"},
                 {"0 is no port; write a number from 1 to 65535"}),
      bad_option("port_that_is_no_number", {"--endpoint", "udp:127.0.0.1:modbus"},
                 {"'modbus' is no port"}),
      bad_option("no_port_of_a_serial_server",
                 {"--endpoint", "tcp:127.0.0.1?protocol=xgt-cnet", "--profile", "xbc-h"},
                 {"there is no port", "write tcp:127.0.0.1:PORT"}),
      bad_option("no_host", {"--endpoint", "tcp::502"}, {"there is no host; write HOST:PORT"}),
      bad_option("address_of_several_colons", {"--endpoint", "tcp:::1:502"},
                 {"several colons", "[::1]:502"}),
      bad_option("open_bracket_of_an_address", {"--endpoint", "tcp:[::1:502"},
                 {"brackets", "[IPV6]:PORT"}),
      bad_option("second_port_out_of_range", {"--endpoint", "tcp:127.0.0.1:2004?udp=0"},
                 {"udp is '0'", "1 to 65535"}),
      bad_option("speed_of_a_socket", {"--endpoint", "tcp:127.0.0.1:4001?line=9600-8N1"},
                 {"a socket has no speed", "line=raw"}),
      bad_option("datagrams_of_a_line", {"--endpoint", "tcp:127.0.0.1:4001?line=raws"},
                 {"line is 'raws'"}),
      bad_option("vectors_absent", {"--vectors", "FOLDER/nowhere"},
                 {"FOLDER/nowhere", "--vectors"}),
      bad_option("unknown_option", {"--endpiont", "emulator:"}, {"--endpiont"}),
      bad_option("gtest_filter", {"--gtest_filter=*"}, {"--gtest_filter", "use --filter"}),
      bad_option("gtest_repeat", {"--gtest_repeat=2"}, {"--gtest_repeat", "use --repeat"}),
      bad_option("gtest_output", {"--gtest_output=xml"}, {"--gtest_output", "--junit"}),
      bad_option("negative_repeat", {"--repeat", "-1"}, {"--repeat"}),
      bad_option("seed_no_number", {"--seed", "today"}, {"--seed", "today"}),
      bad_option("fail_on_what", {"--fail-on", "everything"}, {"--fail-on", "everything"}),
      bad_option("fence_not_readable", {"--allow-write", "M9-M1"}, {"--allow-write", "M9-M1"}),
      bad_option("fence_of_no_area", {"--allow-write", "Z"},
                 {"cannot read --allow-write 'Z': no protocol has such memory"}),
      bad_option("fence_of_no_words", {"--allow-write", "Z1-Z9"},
                 {"cannot read --allow-write 'Z1-Z9'"}),
      bad_option("gtest_unknown", {"--gtest_shufle"},
                 {"unknown argument '--gtest_shufle'; did you mean '--gtest_shuffle'?"}),
      bad_option("gtest_seed_no_number", {"--gtest_random_seed=x"},
                 {"--gtest_random_seed=x: write a number from 0 to 99999"}),
      bad_option("unknown_endpoint", {"--endpoint", "seriell:/dev/ttyUSB0"}, {"seriell", "serial"}),
      bad_option("endpoint_without_target", {"--endpoint", "serial:"}, {"serial:", "/dev/ttyUSB0"}),
      bad_option("unknown_endpoint_option", {"--endpoint", "serial:/dev/null?bauds=9600"},
                 {"bauds", "baud"}),
      bad_option("unknown_protocol", {"--endpoint", "emulator:xbc-h?protocol=profibus"},
                 {"profibus", "xgt-cnet"}),
      bad_option("station_out_of_range", {"--endpoint", "emulator:xbc-h?station=256"},
                 {"256", "0 to 255"}),
      bad_option("unknown_profile", {"--profile", "xbc-g"}, {"xbc-g", "xbc-h"}),
      bad_option("unknown_model", {"--endpoint", "emulator:xbc-g"}, {"xbc-g", "xbc-h"}),
      bad_option("definition_without_cases",
                 {"--endpoint",
                  "emulator:" FIELDPROOF_SOURCE_DIR "/suites/user_frames/examples/balance.json"},
                 {"balance.json", "no selected case is for 'balance'", "--vectors FILE"}),
      bad_option("waivers_absent", {"--waivers", "FOLDER/nothing.json"}, {"FOLDER/nothing.json"}),
      bad_waivers("waivers_malformed", "[{\"id\": ",
                  {"FOLDER/waivers.json: line 1, column 9: the file ends where a value is due"}),
      bad_waivers(
          "waiver_owner_of_no_text",
          R"([{"id": "*", "reason": "r", "owner": 5, "text": "t", "expires": "2999-01-01"}])",
          {"waivers.json", "entry 0", "'owner' is not a text: who answers for it"}),
      bad_waivers("waiver_firmware_of_no_range",
                  R"([{"id": "*", "reason": "r", "owner": "o", "text": "t", "expires": "2999-01-01",
                      "firmware": "1.4"}])",
                  {"entry 0", "'firmware' is a range: {\"from\": \"1.20\""}),
      bad_waivers("waiver_unknown_key",
                  R"([{"id": "*", "reason": "r", "expires": "2999-01-01", "expired": "x"}])",
                  {"waivers.json", "entry 0", "expired"}),
      bad_waivers("waiver_without_date",
                  R"([{"id": "*", "reason": "r", "owner": "o", "text": "t", "expires": "soon"}])",
                  {"waivers.json", "entry 0", "soon"}),
      bad_waivers(
          "waiver_for_unknown_case",
          R"([{"id": "xgt_cnet/rss/no_such", "reason": "r", "owner": "o", "text": "t", "expires": "2999-01-01"}])",
          {"xgt_cnet/rss/no_such"}),
      bad_profile("profile_malformed", "{\"name\": }",
                  {"profile.json: line 1, column 10: there is '}' where a value is due"}),
      bad_profile("profile_unknown_protocol",
                  R"({"name": "profile.json", "protocols": ["xgt-cnt"], "model": "xbc-h"})",
                  {"there is no protocol 'xgt-cnt'", "did you mean 'xgt-cnet'?"}),
      bad_profile("profile_unknown_model",
                  R"({"name": "profile.json", "extends": "xbc-h", "model": "xbc-q"})",
                  {"no case is for the model 'xbc-q'", "did you mean 'xbc-h'?"}),
      bad_profile("profile_guard_band",
                  R"({"name": "p", "extends": "xbc-h", "timing": {"guard_band": 2}})",
                  {"timing.guard_band 2 is no share of a limit; write 0.1 for a tenth"}),
      bad_profile("profile_guard_band_of_text",
                  R"({"name": "p", "extends": "xbc-h", "timing": {"guard_band": "x"}})",
                  {"timing.guard_band is a number: write it without quotes"}),
      bad_profile("profile_timing_of_no_object",
                  R"({"name": "p", "extends": "xbc-h", "timing": 5})", {"timing is an object"}),
      bad_profile("profile_decisions",
                  R"({"name": "p", "extends": "xbc-h", "decisions": "bindin"})",
                  {"decisions is \"binding\", \"advisory\", or a list"}),
      bad_profile("profile_exclude",
                  R"({"name": "p", "extends": "xbc-h", "exclude": [{"id": "*"}]})",
                  {"exclude is a list: [{\"id\": \"GLOB\", \"reason\": \"why\"}]"}),
      bad_profile("profile_unknown_key",
                  R"({"name": "p", "protocols": ["xgt-cnet"], "modell": "xbc-h"})",
                  {"modell", "model"}),
      bad_profile("profile_unknown_timing",
                  R"({"name": "p", "protocols": ["xgt-cnet"], "timing": {"response": 5}})",
                  {"timing.response"}),
      bad_profile("profile_wrong_type", R"({"name": "p", "protocols": "xgt-cnet"})",
                  {"protocols is a list of texts: [\"...\"]"}),
  };
}

std::string in_folder(std::string text, const TestFolder& folder) {
  for (std::size_t at; (at = text.find("FOLDER")) != std::string::npos;)
    text.replace(at, 6, folder.path());
  return text;
}

class BadInputs : public testing::TestWithParam<BadInput> {};

TEST_P(BadInputs, one_message_and_nothing_sent) {
  const BadInput& input = GetParam();
  const TestFolder folder;
  if (!input.file.empty()) folder.write(input.path, input.file);
  // A device that would leave a trace; the argument under test comes later and counts where it is
  // an endpoint too.
  std::vector<std::string> arguments{"run", "--out", folder / "out"};
  const auto names = [&](const char* option) {
    return std::ranges::find(input.arguments, option) != input.arguments.end();
  };
  if (!names("--endpoint"))
    arguments.insert(arguments.end(),
                     {"--endpoint", "exec:touch " + quoted(folder / "started") + "; cat"});
  if (!names("--endpoint") && !names("--profile"))
    arguments.insert(arguments.end(), {"--profile", "xbc-h"});
  if (!names("--vectors"))  // what is wrong is not in the vectors: one is quick
    arguments.insert(arguments.end(),
                     {"--vectors", write_vectors(folder, {small_vector("rss/one")})});
  for (const std::string& one : input.arguments) arguments.push_back(in_folder(one, folder));
  const Finished finished = run_tool(arguments);
  EXPECT_EQ(finished.code, input.code) << finished.out << finished.err;
  for (const std::string& part : input.message)
    EXPECT_THAT(finished.err, HasSubstr(in_folder(part, folder)));
  std::size_t messages = 0;
  for (std::size_t at = 0; (at = finished.err.find("fieldproof: ", at)) != std::string::npos; ++at)
    ++messages;
  EXPECT_LE(messages, 1u) << finished.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "started")) << "the device was started";
  EXPECT_FALSE(std::filesystem::exists(folder / "out/junit.xml"));
}

INSTANTIATE_TEST_SUITE_P(Each, BadInputs, testing::ValuesIn(bad_inputs()),
                         [](const auto& one) { return std::string(one.param.name); });

/// A folder of vectors that `lint` accepts, with what `lint` needs besides: manuals, statements,
/// verified quotes.
class Lint : public testing::Test {
 protected:
  Lint() {
    folder_.write("vectors/manuals.json",
                  R"([{"id": "m", "file": "m.txt", "title": "Manual", "edition": "1"}])");
    folder_.write("vectors/statements/m.json",
                  R"([{"id": "m/1", "section": "1", "quote": "reads one word from the device"}])");
    folder_.write("manuals/m.txt", "The frame reads one  word\nfrom the device.");
    good_ = small_vector("lint/one");
    good_["steps"][0]["wire"] = "05 30 31 72 53 53 30 31 30 36 25 4D 57 31 30 30 04 41 33";
    good_["steps"][1]["wire"] = "06 30 31 72 53 53 30 31 30 32 30 30 30 30 03 30 35";
    EXPECT_EQ(lint(good_, {"--manuals", folder_ / "manuals", "--lock"}).code, 0);
  }

  Finished lint(const ordered_json& vector, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{"lint", "--vectors", write_vectors(folder_, {vector})};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_tool(arguments);
  }

  TestFolder folder_;
  ordered_json good_;
};

TEST_F(Lint, accepts_the_good_vector) {
  const Finished finished = lint(good_);
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("1 cases, 0 tables, 1 statements, 0 errata: 0 problems"));
}

TEST_F(Lint, names_the_byte_where_wire_and_notation_differ) {
  ordered_json bad = good_;
  bad["steps"][0]["wire"] = "05 30 31 72 53 53 30 31 30 36 25 4D 57 31 31 30 04 41 33";
  const Finished finished = lint(bad);
  EXPECT_EQ(finished.code, 2);
  EXPECT_THAT(finished.out,
              AllOf(HasSubstr("xgt_cnet/test.json: xgt_cnet/lint/one: steps[0]: wire and notation "
                              "differ at byte 14: wire has 31, notation has 30"),
                    HasSubstr(": 1 problems")));
}

TEST_F(Lint, wants_literal_bytes_for_each_step) {
  ordered_json bad = good_;
  bad["steps"][1].erase("wire");
  const Finished finished = lint(bad);
  EXPECT_EQ(finished.code, 2);
  EXPECT_THAT(finished.out, HasSubstr("xgt_cnet/lint/one: steps[1]: no wire"));
}

TEST_F(Lint, takes_literal_bytes_from_the_second_entry) {
  ordered_json bare = good_;
  const std::string wire = bare["steps"][1]["wire"];
  bare["steps"][1].erase("wire");
  folder_.write("vectors/wires/xgt_cnet/test.json",
                ordered_json({{"xgt_cnet/lint/one", {{"1", wire}}}}).dump());
  EXPECT_EQ(lint(bare).code, 0);
  folder_.write("vectors/wires/xgt_cnet/test.json",
                ordered_json({{"xgt_cnet/lint/none", {{"1", wire}}}}).dump());
  const Finished unknown = lint(bare);
  EXPECT_EQ(unknown.code, 2);
  EXPECT_THAT(unknown.out, HasSubstr("xgt_cnet/lint/none: no such case"));
}

TEST_F(Lint, names_what_is_cited_and_not_there) {
  ordered_json bad = good_;
  bad["source"]["manual"] = "n";
  bad["statement"] = "m/2";
  const Finished finished = lint(bad);
  EXPECT_EQ(finished.code, 2);
  EXPECT_THAT(finished.out, AllOf(HasSubstr("xgt_cnet/lint/one: no manual 'n'"),
                                  HasSubstr("xgt_cnet/lint/one: no statement 'm/2'"),
                                  HasSubstr("m/1 has neither a vector nor a reason")));
}

TEST_F(Lint, says_of_a_file_that_cannot_be_read_that_alone) {
  ordered_json bad = good_;
  bad["statement"] = "m/2";
  folder_.write("vectors/statements/n.json", R"([{"id": "m/2", "section": "1",, "quote": "q"}])");
  const Finished finished = lint(bad);
  EXPECT_EQ(finished.code, 2);
  EXPECT_THAT(finished.out, AllOf(HasSubstr("statements/n.json: "), HasSubstr(": 1 problems"),
                                  testing::Not(HasSubstr("no statement"))));
}

TEST_F(Lint, notices_a_changed_quote_without_the_manuals) {
  ordered_json bad = good_;
  bad["source"]["quote"] = "reads two words from the device";
  const Finished finished = lint(bad);
  EXPECT_EQ(finished.code, 2);
  EXPECT_THAT(finished.out, HasSubstr("xgt_cnet/lint/one: the quote is not the one last verified"));
  EXPECT_THAT(lint(bad, {"--manuals", folder_ / "manuals"}).out,
              HasSubstr("xgt_cnet/lint/one: the quote does not stand in m"));
}

// ---- ports and folders

/// A run of these vectors against this endpoint, judged as xbc-h.
class BadDevices : public testing::Test {
 protected:
  std::vector<std::string> arguments(const std::string& endpoint, const std::string& vectors) {
    return {"run",       "--endpoint", endpoint, "--profile",    "xbc-h",
            "--vectors", vectors,      "--out",  folder_ / "out"};
  }
  Finished run(const std::string& endpoint, int cases) {
    return run_tool(arguments(endpoint, write_vectors(folder_, many_vectors(cases))));
  }
  Results results() { return read_results(folder_ / "out/results.ndjson"); }

  /// testdata/device.py behind exec:.
  static std::string device(const std::string& behaviour, const std::string& more = "") {
    return "exec:/usr/bin/python3 " FIELDPROOF_SOURCE_DIR "/suites/tool/testdata/device.py " +
           behaviour + " {tty} " + more;
  }

  TestFolder folder_;
};

TEST_F(BadDevices, port_in_use) {
  Result<os::PtyPair> pty = os::open_pty_pair();
  ASSERT_TRUE(pty) << pty.error().message;
  ASSERT_EQ(::flock(pty->slave.get(), LOCK_EX | LOCK_NB), 0);
  const Finished finished = run("serial:" + pty->path, 1);
  EXPECT_EQ(finished.code, 3);
  EXPECT_THAT(finished.err, AllOf(HasSubstr(pty->path), HasSubstr("in use")));
  char byte = 0;
  EXPECT_LE(::read(pty->master.get(), &byte, 1), 0) << "something was sent";
}

TEST_F(BadDevices, host_that_does_not_resolve) {
  const Finished finished = run("tcp:plc.invalid:4001", 1);
  EXPECT_EQ(finished.code, 3);
  EXPECT_THAT(finished.err,
              AllOf(HasSubstr("cannot find host 'plc.invalid'"), HasSubstr("write its address")));
}

TEST_F(BadDevices, refused_connection) {
  os::UniqueFd nobody = os::test::bound(SOCK_STREAM);
  const std::string where = "127.0.0.1:" + std::to_string(os::test::port_of(nobody));
  nobody.reset();
  const Finished finished = run("tcp:" + where, 1);
  EXPECT_EQ(finished.code, 3);
  EXPECT_THAT(finished.err, AllOf(HasSubstr("cannot connect to " + where), HasSubstr("port")));
  EXPECT_THAT(finished.err, testing::Not(HasSubstr("parity")));
}

TEST(BadEmulate, addresses_and_ports) {
  const os::UniqueFd taken = os::test::bound(SOCK_STREAM);
  const std::string in_use = "127.0.0.1:" + std::to_string(os::test::port_of(taken));
  const auto expect = [](const std::string& address, int code, const std::string& message) {
    const Finished finished = run_tool({"emulate", "xbc-h", "--tcp", address});
    EXPECT_EQ(finished.code, code) << address;
    EXPECT_THAT(finished.err, HasSubstr(message));
  };
  expect(in_use, 3,
         "cannot listen on " + in_use +
             ": the port is in use; end the program that has it, or choose another port");
  expect("127.0.0.1:65536", 2, "'65536' is no port; write a number up to 65535");
  expect("127.0.0.1", 2, "there is no port; write PORT or HOST:PORT");
  expect("::1:4001", 2, "several colons");
  expect("plc.invalid:4001", 3, "cannot find host 'plc.invalid'");
  expect("192.0.2.7:4001", 3, "this is no address of this computer");
}

TEST(BadEmulate, protocol_without_frames) {
  const Finished served = run_tool({"emulate", "xdc?protocol=xnet", "--tcp", "127.0.0.1:0"});
  EXPECT_EQ(served.code, 2);
  EXPECT_THAT(served.err, HasSubstr("xnet has no frame that a manual prints"));
  const Finished asked =
      run_tool({"run", "--protocol", "hs-link", "--endpoint", "tcp:127.0.0.1:1"});
  EXPECT_EQ(asked.code, 2);
  EXPECT_THAT(asked.err, HasSubstr("tested on a model alone; write emulator:"));
}

TEST_F(BadDevices, no_terminal) {
  const std::string file = folder_.write("file", "");
  const Finished finished = run("serial:" + file, 1);
  EXPECT_EQ(finished.code, 3);
  EXPECT_THAT(finished.err, HasSubstr(file));
}

TEST_F(BadDevices, command_that_does_not_exist) {
  const Finished finished = run("exec:/no/such/device {tty}", 1);
  EXPECT_EQ(finished.code, 3);
  EXPECT_THAT(finished.err, AllOf(HasSubstr("/no/such/device"), HasSubstr("127")));
}

/// The parent of the folder is a file: not even root can write there.
TEST_F(BadDevices, unwritable_out_folder) {
  const std::string blocked = folder_.write("file", "") + "/out";
  std::vector<std::string> all = arguments("exec:cat >" + quoted(folder_ / "received"),
                                           write_vectors(folder_, many_vectors(1)));
  all.back() = blocked;
  const Finished finished = run_tool(all);
  EXPECT_EQ(finished.code, 3);
  EXPECT_THAT(finished.err,
              AllOf(HasSubstr("cannot make the folder " + blocked), HasSubstr("--out")));
  EXPECT_EQ(read_text(folder_ / "received"), "") << "something was sent";
}

/// One report that cannot be written is trouble, and the others are there.
TEST_F(BadDevices, unwritable_report) {
  const std::string blocked = folder_.write("file", "") + "/junit.xml";
  const Finished finished = run_tool({"run", "--vectors", write_vectors(folder_, many_vectors(1)),
                                      "--out", folder_ / "out", "--junit", blocked});
  EXPECT_EQ(finished.code, 3);
  EXPECT_THAT(finished.err, HasSubstr(blocked));
  EXPECT_EQ(nlohmann::json::parse(read_text(folder_ / "out/results.json"))["counts"]["PASS"], 1);
}

// ---- devices

TEST_F(BadDevices, healthy_one_is_green) {
  const Finished finished = run(device("good"), 5);
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  EXPECT_EQ(results().counts(), (std::map<std::string, std::size_t>{{"PASS", 5}}));
}

/// The command of a report can be pasted into a shell, whatever the endpoint is.
TEST_F(BadDevices, replay_command_runs_the_case_again) {
  const std::string vectors = write_vectors(
      folder_, {small_vector("replay/wrong", wrong_word), small_vector("replay/right")});
  const std::string endpoint = "exec:sh -c " + quoted("exec /usr/bin/python3 " FIELDPROOF_SOURCE_DIR
                                                      "/suites/tool/testdata/device.py good {tty}");
  ASSERT_EQ(run_tool(arguments(endpoint, vectors)).code, 1);
  const std::string replay = results().of("xgt_cnet/replay/wrong").at("replay");
  const std::string folder_of_tool = std::filesystem::path(FIELDPROOF_TOOL).parent_path();
  const Finished again = run_program(
      {"/bin/sh", "-c", replay},
      {.environment = {{"PATH", folder_of_tool + ":/usr/bin:/bin"}}, .folder = folder_.path()});
  EXPECT_EQ(again.code, 1) << replay << '\n' << again.out << again.err;
  EXPECT_EQ(read_results(folder_ / "fieldproof-out/results.ndjson").ids(),
            std::vector<std::string>{"xgt_cnet/replay/wrong"});
}

/// What it said last is the best hint there is.
// Twenty requests more than the cases need: the floor of the link is measured first.
TEST_F(BadDevices, one_that_dies) {
  const Finished finished = run(device("die", "26"), 8);
  EXPECT_EQ(finished.code, 1) << finished.out;
  const std::map<std::string, std::size_t> counts = results().counts();
  EXPECT_EQ(counts.at("FAIL"), 1u) << "the case in which it died, and no other";
  EXPECT_EQ(counts.at("PASS"), 7u) << "it was started again";
  EXPECT_THAT(finished.out,
              AllOf(HasSubstr("the device ended after ENQ"), HasSubstr("exit status 3"),
                    HasSubstr("the device has burnt out")));
  expect_reports(folder_ / "out");
}

/// The bench starts it again, since it can; the case is judged all the same.
TEST_F(BadDevices, one_that_hangs) {
  const Finished finished = run(device("mute", "24"), 4);
  EXPECT_EQ(finished.code, 1) << finished.out << finished.err;
  const std::map<std::string, std::size_t> counts = results().counts();
  EXPECT_GE(counts.at("PASS"), 1u);
  EXPECT_GE(counts.at("FAIL"), 1u);
  EXPECT_EQ(counts.size(), 2u) << finished.out;
  EXPECT_THAT(finished.out, HasSubstr("link dead after this frame"));
  expect_reports(folder_ / "out");
}

TEST_F(BadDevices, one_that_floods) {
  const Finished finished = run(device("flood", "24"), 4);
  EXPECT_EQ(finished.code, 1) << finished.out << finished.err;
  EXPECT_GE(results().counts().at("PASS"), 1u);
  EXPECT_GE(results().counts().at("FAIL"), 1u);
  EXPECT_THAT(finished.out, HasSubstr("floods"));
  expect_reports(folder_ / "out");
}

TEST_F(BadDevices, one_byte_a_second) {
  const Finished finished = run(device("drip"), 1);
  EXPECT_EQ(finished.code, 1) << finished.out << finished.err;
  EXPECT_EQ(results().counts(), (std::map<std::string, std::size_t>{{"FAIL", 1}}));
  EXPECT_LT(results().end.at("seconds").get<double>(), 60);
  expect_reports(folder_ / "out");
}

TEST_F(BadDevices, pty_that_closes) {
  const std::string link = folder_ / "port";
  Process far_end({"/usr/bin/python3", FIELDPROOF_SOURCE_DIR "/suites/tool/testdata/device.py",
                   "close", link, "24"});
  ASSERT_TRUE(far_end.wait_for("ready"));
  const Finished finished = run("serial:" + link, 6);
  EXPECT_EQ(finished.code, 3) << finished.out << finished.err;
  EXPECT_EQ(results().counts().at("ERROR"), 1u);
  EXPECT_GE(results().counts().at("PASS"), 1u);
  EXPECT_THAT(finished.out, AllOf(HasSubstr(link), HasSubstr("the far end is gone")));
  expect_reports(folder_ / "out");
}

// ---- nested without end

/// A value within a value, so deep that who goes down the levels one by one runs out of stack.
std::string deep(const std::string& before = "", const std::string& behind = "") {
  constexpr int levels = 100'000;
  std::string text = before;
  for (int i = 0; i < levels; ++i) text += "{\"a\":";
  return text + '1' + std::string(levels, '}') + behind;
}

struct DeepFile {
  const char* name;
  std::string text;
  std::vector<std::string> arguments;  // FILE stands for it
};
void PrintTo(const DeepFile& file, std::ostream* out) { *out << file.name; }

class Deep : public testing::TestWithParam<DeepFile> {};

TEST_P(Deep, IsRefused) {
  const TestFolder folder;
  const std::string file = folder.write("vectors.json", GetParam().text);
  std::vector<std::string> arguments = GetParam().arguments;
  std::ranges::replace(arguments, std::string("FILE"), file);
  const Finished finished = run_tool(arguments, {.environment = {}, .folder = folder.path()});
  EXPECT_EQ(finished.code, 2) << finished.out << finished.err;
  EXPECT_THAT(finished.out + finished.err, HasSubstr("vectors.json"));
}

INSTANTIATE_TEST_SUITE_P(
    By, Deep,
    testing::Values(
        DeepFile{"bench", deep("{\"devices\": ", "}"), {"run", "--bench", "FILE", "--dut", "a"}},
        DeepFile{"profile", deep(), {"run", "--profile", "FILE"}},
        DeepFile{"waivers", deep("[", "]"), {"run", "--waivers", "FILE"}},
        DeepFile{"vectors",
                 deep("[{\"id\": \"xgt_cnet/a/b\", \"given\": {\"config\": ",
                      "}, \"steps\": [{\"send\": \"[ENQ]\"}]}]"),
                 {"run", "--vectors", "FILE"}},
        DeepFile{"definition", deep(), {"emulate", "FILE", "--tcp", "0"}},
        DeepFile{"config",
                 deep("{\"station\": ", "}"),
                 {"emulate", "xbc-h", "--config", "FILE", "--tcp", "0"}},
        DeepFile{
            "p2p", deep("{\"p2p\": ", "}"), {"emulate", "xbc-h", "--p2p", "FILE", "--tcp", "0"}},
        DeepFile{"results", deep("{\"run\": ", "}\n"), {"report", "FILE", "--json", "r.json"}},
        DeepFile{"journal", deep("{\"saved\": ", "}\n"), {"restore", "FILE"}},
        DeepFile{"compared", deep(), {"compare", "FILE", "FILE"}}),
    [](const auto& one) { return std::string(one.param.name); });

// ---- interrupted and killed

/// Waits until something opens the FIFO and writes to it, as testdata/device.py does with 'tell'.
class Fifo {
 public:
  explicit Fifo(std::string path) : path_(std::move(path)) {
    EXPECT_EQ(::mkfifo(path_.c_str(), 0600), 0);
    fd_ = ::open(path_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  }
  ~Fifo() { ::close(fd_); }
  bool told() const {
    pollfd one{fd_, POLLIN, 0};
    return ::poll(&one, 1, 60'000) == 1;
  }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  int fd_ = -1;
};

/// A run in the middle: the device has fallen silent, and the bench waits for it.
class InTheMiddle : public BadDevices {
 protected:
  static constexpr int asked = 41, cases = 200;

  std::unique_ptr<Process> start(int until, const char* behaviour = "tell") {
    auto tool = std::make_unique<Process>(tool_arguments(
        arguments(device(behaviour, quoted(fifo_.path()) + ' ' + std::to_string(until)),
                  write_vectors(folder_, many_vectors(cases)))));
    EXPECT_TRUE(fifo_.told());
    return tool;
  }
  void expect_some() {
    EXPECT_GE(results().cases.size(), 1u);
    EXPECT_LT(results().cases.size(), std::size_t(cases));
  }

  Fifo fifo_{folder_ / "asked"};
};

class Interrupted : public InTheMiddle, public testing::WithParamInterface<int> {};

TEST_P(Interrupted, is_130_with_reports) {
  const std::unique_ptr<Process> tool = start(asked);
  tool->signal(GetParam());
  const Finished finished = tool->wait();
  EXPECT_EQ(finished.code, 130) << finished.out << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("exit 130: interrupted"));
  EXPECT_EQ(results().end.at("interrupted"), true);
  expect_some();
  expect_reports(folder_ / "out");
}

INSTANTIATE_TEST_SUITE_P(By, Interrupted, testing::Values(SIGINT, SIGTERM), [](const auto& one) {
  return one.param == SIGINT ? "ctrl_c" : "termination";
});

/// However fast the bytes come.
TEST_F(InTheMiddle, an_interrupt_in_a_flood_is_130_with_reports) {
  const std::unique_ptr<Process> tool = start(asked, "tell_flood");
  tool->signal(SIGTERM);
  const Finished finished = tool->wait();
  EXPECT_EQ(finished.code, 130) << finished.out << finished.err;
  EXPECT_EQ(results().end.at("interrupted"), true);
  expect_some();
  expect_reports(folder_ / "out");
}

/// Before the first case, too: nothing was judged, and that is no success.
TEST_F(InTheMiddle, interrupt_while_nothing_answers_is_130) {
  const std::unique_ptr<Process> tool = start(0);
  tool->signal(SIGINT);
  const Finished finished = tool->wait();
  EXPECT_EQ(finished.code, 130) << finished.out << finished.err;
  expect_reports(folder_ / "out");
}

TEST_F(InTheMiddle, report_after_a_kill) {
  const std::unique_ptr<Process> tool = start(asked);
  tool->signal(SIGKILL);
  EXPECT_EQ(tool->wait().code, 128 + SIGKILL);
  expect_some();
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out/junit.xml"));
  const Finished report =
      run_tool({"report", folder_ / "out/results.ndjson", "--junit", folder_ / "out/junit.xml",
                "--json", folder_ / "out/results.json"});
  EXPECT_EQ(report.code, 0) << report.err;
  expect_reports(folder_ / "out");
  EXPECT_THAT(read_text(folder_ / "out/junit.xml"), HasSubstr("the run was killed"));
}

TEST(Report, names_the_damaged_line) {
  const TestFolder folder;
  const std::string file =
      folder.write("results.ndjson", "{\"run\":{}}\n{\"case\":\n{\"end\":{}}\n");
  const Finished finished = run_tool({"report", file, "--junit", folder / "junit.xml"});
  EXPECT_EQ(finished.code, 2);
  EXPECT_THAT(finished.err, HasSubstr(file));
  EXPECT_FALSE(std::filesystem::exists(folder / "junit.xml"));
}

}  // namespace
}  // namespace fieldproof::tool_tests
