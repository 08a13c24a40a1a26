// Requests, what becomes of them, and sequences that are held against our own device.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "harness/bench/bench.hpp"
#include "harness/endpoints/emulator.hpp"
#include "harness/explore/client_sequences.hpp"
#include "harness/explore/explorer.hpp"
#include "harness/explore/server_sequences.hpp"
#include "harness/explore/vector_text.hpp"
#include "harness/vectors/loader.hpp"
#include "harness/vectors/test_own_vectors.hpp"
#include "suites/broken/wrapped_device.hpp"
#include "suites/protocols.hpp"

namespace fieldproof::explore {
namespace {

using harness::Protocol;
using results::CaseResult;
using results::Verdict;
using testing::AllOf;
using testing::Contains;
using testing::Ge;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Le;
using testing::Not;
using vectors::Case;

const Protocol& protocol(const char* name) { return *suites::protocols().find(name); }

Request request(const std::string& text) {
  return {"rss", "xgt_cnet/rss/one", *notation::parse_notation(text)};
}

std::vector<safety::WriteFence::Words> all_of_it(const std::string&) { return {{0, 999}}; }

constexpr const char* read_word = "[ENQ st 'rSS' '01' name(%MW100) EOT BCC]";

const std::vector<Case>& cases(const char* folder) {
  return vectors::test::own_vectors(suites::protocols(), std::string(folder) + "/*").cases;
}

Bytes bytes_of(const Request& one, const Protocol& own) {
  return *safety::bytes_of(one.notation, own.fields_at(1));
}

/// A device of the protocol, in process; `make` may make a broken one.
class InProcess {
 public:
  explicit InProcess(const Protocol& own, endpoints::DeviceFactory make = {}, bool binding = true)
      : endpoint_(
            {"emulator", own.models().front(), {}},
            make ? std::move(make)
                 : [&own](std::string_view model,
                          const nlohmann::json& config) { return own.make_device(model, config); },
            {}, own.default_port()),
        bench_(endpoint_, own, options(own, binding)) {}

  CaseResult run(const Case& one) { return bench_.run(one); }

 private:
  static bench::BenchOptions options(const Protocol& own, bool binding) {
    bench::BenchOptions options;
    options.profile.name = "emulator";
    options.profile.protocols = {std::string(own.name())};
    options.profile.decisions.all = binding;
    options.known = suites::protocols();
    return options;
  }
  endpoints::EmulatorEndpoint endpoint_;
  bench::Bench bench_;
};

Explorer explorer(const Protocol& own, InProcess& device, const std::vector<Case>& from,
                  std::uint64_t seed = 1, Server server = {}) {
  server.protocol = &own;
  const std::string model = own.models().front();
  return Explorer(
      {&own, [&device](const Case& one) { return device.run(one); }},
      std::make_unique<ServerSequences>(std::move(server), std::move(*Oracle::open(own, model, 1)),
                                        requests_of(from, own, model), seed));
}

Counts counts_of(const Protocol& own) { return Counts(own, 1, {}); }

/// The connection that a part goes over; empty: the only one.
std::string link_of(const Sequence& sequence, std::size_t part) {
  const Case one = sequence.as_case("x");
  for (const vectors::Step& step : one.steps)
    if (step.kind == vectors::Step::Kind::send && part-- == 0) return step.on;
  return {};
}

/// What follows on a connection might be the rest of what is not answered: a wait for each.
TEST(ServerSequences, NothingComesBehindASilenceOverTheWire) {
  const Protocol& fenet = protocol("xgt-fenet");
  const std::string model = fenet.models().front();
  ServerSequences sequences(Server{.protocol = &fenet, .over_the_wire = true},
                            std::move(*Oracle::open(fenet, model, 1)),
                            requests_of(cases("xgt_fenet"), fenet, model), 1);
  std::size_t silences = 0;
  for (int i = 0; i < 300; ++i) {
    const Sequence::Own one = sequences.invent();
    std::set<std::string> silent;  // connections
    for (std::size_t part = 0; one && part < one->parts(); ++part) {
      const std::string link = link_of(*one, part);
      EXPECT_FALSE(silent.contains(link)) << "part " << part;
      if (one->outcome(part) == "silence") silent.insert(link);
    }
    silences += silent.size();
  }
  EXPECT_GT(silences, 0u);
}

TEST(RequestsOf, AreThoseThatSayAllOfTheirBytes) {
  const std::vector<Request> all = requests_of(cases("xgt_cnet"), protocol("xgt-cnet"), "xbc-h");
  EXPECT_GT(all.size(), 500u);
  for (const Request& one : all) {
    EXPECT_TRUE(safety::bytes_of(one.notation, protocol("xgt-cnet").fields_at(1)));
    EXPECT_FALSE(one.topic.empty());
  }
}

TEST(NotationOf, HasStationAndCheckAsWords) {
  const Bytes nak = *from_hex("15 30 31 72 53 53 30 30 31 31 03 35 33");
  const Protocol& cnet = protocol("xgt-cnet");
  const std::string text = notation::print(notation_of(nak, false, cnet, 1));
  EXPECT_THAT(text, AllOf(HasSubstr(" st "), HasSubstr("BCC")));
  EXPECT_EQ(*safety::bytes_of(*notation::parse_notation(text), cnet.fields_at(1)), nak);
}

/// The type of a CPU and the place of a module are the device's own.
TEST(NotationOf, LeavesOpenWhatVectorsDo) {
  const Bytes reply = *from_hex(
      "4C 53 49 53 2D 58 47 54 00 00 07 01 B0 11 01 00 0A 00 02 31 59 00 02 00 00 00 00 00 01 00");
  const Protocol& fenet = protocol("xgt-fenet");
  EXPECT_THAT(notation::print(notation_of(reply, false, fenet, 1)),
              AllOf(HasSubstr("00 00 ?? ?? ?? 11 01 00 LEN ?? ?? 59 00 02 00 ??*2 00 00 01 00")));
  EXPECT_THAT(notation::print(notation_of(reply, true, fenet, 1)), Not(HasSubstr("??")));
}

/// The check stays wrong, and nothing moves.
TEST(NotationOf, LeavesWhatIsWrong) {
  const Bytes nak = *from_hex("15 30 31 72 53 53 30 30 31 31 03 30 30");
  const Protocol& cnet = protocol("xgt-cnet");
  EXPECT_THAT(notation::print(notation_of(nak, false, cnet, 1)), Not(HasSubstr("BCC")));
}

TEST(Changes, ElsewhereIsARightRequest) {
  const Protocol& cnet = protocol("xgt-cnet");
  const Changes changes(cnet, 1, true, counts_of(cnet));
  Random random(1);
  HotWords hot(all_of_it);
  std::set<Bytes> seen;
  for (int i = 0; i < 50; ++i) {
    Request one = request(read_word);
    changes.make("elsewhere", one, hot, random);  // not where it would be as it is
    const Bytes bytes = bytes_of(one, cnet);
    EXPECT_TRUE(harness::faultless(cnet.explain_as(bytes, true))) << to_text(bytes);
    seen.insert(bytes);
  }
  EXPECT_GT(seen.size(), 8u);
}

TEST(Changes, AFieldChangesAndItsCheckFollows) {
  const Protocol& rtu = protocol("modbus-rtu");
  const Changes changes(rtu, 1, true, counts_of(rtu));
  Random random(2);
  HotWords hot(all_of_it);
  int right = 0;
  for (int i = 0; i < 50; ++i) {
    Request one = request("[st 03 00 63 00 01 CRC]");
    if (!changes.make("field", one, hot, random)) continue;
    EXPECT_THAT(one.change, HasSubstr(" becomes "));
    const Bytes bytes = bytes_of(one, rtu);
    for (const harness::Field& field : rtu.explain_as(bytes, true))
      if (field.name == "CRC") right += field.problem.empty();
  }
  EXPECT_GT(right, 30);
}

struct Resizing {
  const char *protocol, *request;
};

/// Right requests for more or less, with all that belongs to it.
TEST(Changes, ResizedIsARightRequest) {
  for (const auto& [name, text] :
       {Resizing{"xgt-cnet", "[ENQ st 'RSS' '02' name(%MW100) name(%MW101) EOT BCC]"},
        Resizing{"xgt-cnet", "[ENQ st 'WSB' name(%MW100) '02' '00010002' EOT BCC]"},
        Resizing{"xgt-cnet", "[ENQ st 'wSS' '02' name(%MW100) '0001' name(%MW101) '0002' EOT BCC]"},
        Resizing{"modbus-rtu", "[st 10 00 63 00 02 04 00 01 00 02 CRC]"},
        Resizing{"modbus-rtu", "[st 0F 00 63 00 0A 02 FF 01 CRC]"},
        Resizing{"ls-bus", "[ENQ st 'R' '3000' '2' SUM EOT]"}}) {
    const Protocol& own = protocol(name);
    const Changes changes(own, 1, true, counts_of(own));
    Random random(5);
    for (const std::uint32_t count : {1u, 3u, 5u}) {
      Request one = request(text);
      ASSERT_TRUE(changes.resized(one, count, random)) << text;
      const Bytes bytes = bytes_of(one, own);
      EXPECT_TRUE(harness::faultless(own.explain_as(bytes, true)))
          << text << " " << count << ": " << notation::print_bytes(bytes);
      EXPECT_EQ(changes.counts().count_in(bytes)->value, count);
    }
  }
}

/// Letters, order and station leave the check right, and two requests are twice the bytes.
TEST(Changes, AreOfOneKindEach) {
  const Protocol& cnet = protocol("xgt-cnet");
  const Changes changes(cnet, 1, true, counts_of(cnet));
  Random random(6);
  const Bytes whole = bytes_of(request(read_word), cnet);
  Request letters = request(read_word), order = letters, station = letters, twice = letters;
  ASSERT_TRUE(changes.letters(letters, random) && changes.order(order, random) &&
              changes.station(station, random) && changes.twice(twice));
  EXPECT_EQ(bytes_of(order, cnet).size(), whole.size()) << order.change;
  for (const Request& one : {letters, order, station}) {
    EXPECT_NE(bytes_of(one, cnet), whole) << one.change;
  }
  EXPECT_EQ(bytes_of(twice, cnet).size(), 2 * whole.size());
  EXPECT_FALSE(Changes(cnet, 1, false, counts_of(cnet)).station(station, random))
      << "somebody may answer there";
}

TEST(Changes, DamageChangesTheBytesAlone) {
  const Protocol& cnet = protocol("xgt-cnet");
  const Changes changes(cnet, 1, true, counts_of(cnet));
  Random random(3);
  HotWords hot(all_of_it);
  const Bytes whole = bytes_of(request(read_word), cnet);
  for (int i = 0; i < 50; ++i) {
    Request one = request(read_word);
    if (changes.make("damage", one, hot, random)) {
      EXPECT_NE(bytes_of(one, cnet), whole) << one.change;
    }
  }
}

/// What a line without a wire cannot keep is not asked of it.
TEST(Changes, PausesBehindASocketAreLong) {
  const Changes changes(protocol("xgt-cnet"), 1, false, counts_of(protocol("xgt-cnet")));
  Random random(4);
  HotWords hot(all_of_it);
  for (int i = 0; i < 30; ++i) {
    Request one = request(read_word);
    ASSERT_TRUE(changes.make("pause", one, hot, random));
    EXPECT_THAT(one.change, testing::AnyOf(HasSubstr("200 ms"), HasSubstr("1500 ms")));
  }
}

TEST(Sequence, ExpectsWhatOurOwnDeviceAnswers) {
  const Protocol& cnet = protocol("xgt-cnet");
  Oracle oracle = std::move(*Oracle::open(cnet, "xbc-h", 1));
  const std::vector<Request> asked{request(read_word), request("'noise'"),
                                   request("[ENQ st 'rSS' '17' EOT BCC]")};
  const Memory memory{{"%MW100", "12AB"}};
  const auto answers = oracle.ask(asked, memory, Past::none);
  ASSERT_TRUE(answers && answers->size() == 3);
  EXPECT_EQ(sort_of(answers->at(0), cnet), "answered");
  EXPECT_EQ(sort_of(answers->at(1), cnet), "silence");
  EXPECT_THAT(sort_of(answers->at(2), cnet), HasSubstr("0003"));
  const Case one = case_of(asked, *answers, memory, cnet, 1, "xgt_cnet/explore/test");
  EXPECT_EQ(one.basis, "decision");
  EXPECT_THAT(one.steps[1].frames.front().text, HasSubstr("12AB"));
  EXPECT_EQ(one.steps[3].kind, vectors::Step::Kind::silence);
  InProcess device(cnet);
  EXPECT_EQ(device.run(one).verdict, Verdict::pass) << device.run(one).message;
}

/// Two answers that come as one are waited for in one step, which ends where a frame must.
TEST(Sequence, AnswersTooLongForOneStepAreNotJudged) {
  const Protocol& ascii = protocol("modbus-ascii");
  Oracle oracle = std::move(*Oracle::open(ascii, "xbc-h", 1));
  const auto answers_to = [&](const std::string& frame) {
    const auto answers = oracle.ask({request(frame + ' ' + frame)}, {}, Past::none);
    return answers ? answers->size() : 99;
  };
  EXPECT_EQ(answers_to("':010301000001FA' CR LF"), 1u);
  EXPECT_EQ(answers_to("':0103010C007877' CR LF"), 0u) << "982 characters at 9600 baud";
}

/// All that is granted follows from what is printed.
TEST(Sequence, OfWhatIsGrantedIsDerived) {
  const Protocol& cnet = protocol("xgt-cnet");
  Oracle oracle = std::move(*Oracle::open(cnet, "xbc-h", 1));
  const auto answers = oracle.ask({request(read_word)}, {}, Past::none);
  ASSERT_TRUE(answers);
  EXPECT_EQ(case_of({request(read_word)}, *answers, {}, cnet, 1, "x").basis, "derived");
}

/// The file says the same as the case.
TEST(Sequence, AsAFileIsTheSameCase) {
  const Protocol& cnet = protocol("xgt-cnet");
  Oracle oracle = std::move(*Oracle::open(cnet, "xbc-h", 1));
  const Request asked = request(read_word);
  const Memory memory{{"%MW100", "12AB"}};
  const auto answers = oracle.ask({asked}, memory, Past::none);
  ASSERT_TRUE(answers);
  const Case one = case_of({asked}, *answers, memory, cnet, 1, "xgt_cnet/explore/test");
  vectors::VectorSet set;
  vectors::load_vector_text(vector_text(one), "finding.json", set, {suites::protocols()});
  EXPECT_THAT(set.problems, IsEmpty());
  ASSERT_EQ(set.cases.size(), 1u);
  EXPECT_EQ(set.cases.front().memory, one.memory);
  ASSERT_EQ(set.cases.front().steps.size(), one.steps.size());
  for (std::size_t i = 0; i < one.steps.size(); ++i)
    EXPECT_EQ(set.cases.front().steps[i].frames.front().text, one.steps[i].frames.front().text);
}

class HealthyDevices : public testing::TestWithParam<const char*> {};

TEST_P(HealthyDevices, ShowNothing) {
  const Protocol& own = protocol(GetParam());
  std::string folder = GetParam();
  std::ranges::replace(folder, '-', '_');
  InProcess device(own);
  Explorer one = explorer(own, device, cases(folder.c_str()), 77);
  while (one.requests_sent() < 600) one.step();
  EXPECT_THAT(one.findings(), IsEmpty()) << one.findings().begin()->second.result.message;
  EXPECT_GT(one.seen().size(), 15u);
}

INSTANTIATE_TEST_SUITE_P(Explorer, HealthyDevices,
                         testing::Values("xgt-cnet", "modbus-rtu", "modbus-ascii", "modbus-tcp",
                                         "xgt-fenet", "ls-bus"),
                         [](const auto& one) {
                           std::string name = one.param;
                           std::erase(name, '-');
                           return name;
                         });

/// The same seed sends the same requests.
TEST(Explorer, IsRepeatable) {
  const Protocol& cnet = protocol("xgt-cnet");
  const std::vector<Case> from = cases("xgt_cnet");
  std::vector<std::string> first, second;
  for (std::vector<std::string>* sent : {&first, &second}) {
    InProcess device(cnet);
    const std::string model = cnet.models().front();
    const auto run = [&](const Case& one) {
      for (const vectors::Step& step : one.steps)
        if (!step.frames.empty()) sent->push_back(step.frames.front().text);
      return device.run(one);
    };
    Explorer one({&cnet, run},
                 std::make_unique<ServerSequences>(Server{.protocol = &cnet},
                                                   std::move(*Oracle::open(cnet, model, 1)),
                                                   requests_of(from, cnet, model), 5));
    while (one.requests_sent() < 200) one.step();
  }
  EXPECT_EQ(first, second);
}

TEST(Explorer, WaitsForFewSilencesWhereTimeIsReal) {
  const Protocol& rtu = protocol("modbus-rtu");
  const std::vector<Case> from = cases("modbus_rtu");
  const std::string model = rtu.models().front();
  std::map<bool, std::size_t> silences;  // of 2000 requests
  for (const bool real_time : {false, true}) {
    InProcess device(rtu);
    const auto run = [&](const Case& one) {
      for (const vectors::Step& step : one.steps)
        silences[real_time] += step.kind == vectors::Step::Kind::silence;
      return device.run(one);
    };
    Explorer one({.protocol = &rtu, .run = run, .real_time = real_time},
                 std::make_unique<ServerSequences>(Server{.protocol = &rtu},
                                                   std::move(*Oracle::open(rtu, model, 1)),
                                                   requests_of(from, rtu, model), 5));
    while (one.requests_sent() < 2000) one.step();
  }
  EXPECT_GT(silences[false], 250u);
  EXPECT_THAT(silences[true], AllOf(Ge(150u), Le(210u)));
}

/// A healthy device with one of these around it.
template <typename Broken>
endpoints::DeviceFactory wrapped_in(const Protocol& own) {
  return [&own](std::string_view model,
                const nlohmann::json& config) -> Result<std::unique_ptr<plc::EmulatedDevice>> {
    auto good = own.make_device(model, config);
    if (!good) return good.error();
    return std::unique_ptr<plc::EmulatedDevice>(std::make_unique<Broken>(std::move(*good)));
  };
}

/// Loses each sixth frame.
class Forgetful : public broken::WrappedDevice {
 public:
  using WrappedDevice::WrappedDevice;
  void receive(const Burst& burst) override {
    if (++count_ % 6 != 0) WrappedDevice::receive(burst);
  }

 private:
  int count_ = 0;
};

/// What takes six frames is shown by six, however long the sequence was in which it was seen.
TEST(Explorer, AFindingIsAsShortAsItShows) {
  const Protocol& cnet = protocol("xgt-cnet");
  InProcess device(cnet, wrapped_in<Forgetful>(cnet));
  Explorer one = explorer(cnet, device, cases("xgt_cnet"));
  while (one.findings().empty() && one.requests_sent() < 5000) one.step();
  ASSERT_THAT(one.findings(), Not(IsEmpty()));
  const Finding& finding = one.findings().begin()->second;
  EXPECT_TRUE(finding.confirmed);
  EXPECT_EQ(finding.result.verdict, Verdict::fail);
  const auto sends =
      std::ranges::count(finding.shortest.steps, vectors::Step::Kind::send, &vectors::Step::kind);
  EXPECT_LE(sends, 6);
  InProcess good(cnet);
  EXPECT_EQ(good.run(finding.shortest).verdict, Verdict::pass);
}

/// All that comes of a device, one reply a burst.
class Answering : public broken::WrappedDevice {
 public:
  using WrappedDevice::WrappedDevice;
  Bytes advance(Time now) override {
    Bytes reply = WrappedDevice::advance(now);
    return reply.empty() ? reply : changed(std::move(reply));
  }

 protected:
  virtual Bytes changed(Bytes reply) = 0;

  static bool is_nak(const Bytes& reply) { return reply.front() == 0x15; }
  /// Another error code in a NAK of Cnet, whose digits stand behind station and command.
  static Bytes with_code(Bytes nak, const std::string& code) {
    if (nak.size() >= 10) std::ranges::copy(code, nak.begin() + 6);
    return summed(std::move(nak));
  }
  /// A block check where there was one.
  static Bytes summed(Bytes reply) {
    const auto end = std::ranges::find(reply, Byte{0x03});
    if (reply.end() - end != 3) return reply;
    const std::size_t size = static_cast<std::size_t>(end - reply.begin()) + 1;
    unsigned sum = 0;
    for (std::size_t i = 0; i < size; ++i) sum += reply[i];
    std::ranges::copy(fmt::format("{:02X}", sum & 0xFF), reply.begin() + static_cast<long>(size));
    return reply;
  }
};

/// Each word of a granted answer comes with its digits turned round.
class TurnsData : public Answering {
 public:
  using Answering::Answering;

 private:
  Bytes changed(Bytes reply) override {
    if (is_nak(reply) || reply.size() < 17 || reply[3] != 'r') return reply;
    const auto end = std::ranges::find(reply, Byte{0x03});
    if (end - reply.begin() < 14) return reply;
    std::reverse(end - 4, end);
    return summed(std::move(reply));
  }
};

std::string marks(const Explorer& one) {
  std::string text;
  for (const auto& [mark, finding] : one.findings())
    text += mark + ": " + finding.result.message + vector_text(finding.shortest);
  return text;
}

/// Findings whose answer is of another sort than it had to be.
std::ptrdiff_t other_sorts(const Explorer& one) {
  return std::ranges::count_if(one.findings(), [](const auto& each) {
    return each.first.find(" due, ") != std::string::npos;
  });
}

const Finding* first_that_fails(const Explorer& one) {
  for (const auto& [mark, finding] : one.findings())
    if (finding.result.verdict == Verdict::fail) return &finding;
  return nullptr;
}

/// A refusal before it, on which nothing binds, may not make wrong data a matter of decisions.
TEST(Explorer, ANeedlessRefusalHidesNoFailure) {
  const Protocol& cnet = protocol("xgt-cnet");
  for (const std::uint64_t seed : {1u, 3u}) {
    InProcess device(cnet, wrapped_in<TurnsData>(cnet), false);
    Explorer one = explorer(cnet, device, cases("xgt_cnet"), seed, Server{.learns = true});
    while (!first_that_fails(one) && one.requests_sent() < 3000) one.step();
    EXPECT_NE(first_that_fails(one), nullptr) << "seed " << seed;
  }
}

/// The code of one refusal is another: one fault, whatever service and change show it.
class OneCodeForAnother : public Answering {
 public:
  using Answering::Answering;

 private:
  Bytes changed(Bytes reply) override {
    const std::string text = to_text(reply);
    return is_nak(reply) && text.find("1132") == 6 ? with_code(std::move(reply), "0011") : reply;
  }
};

/// All answers go to the client that came first.
class AnswersTheFirst : public plc::EmulatedDevice, public net::Host {
 public:
  explicit AnswersTheFirst(std::unique_ptr<plc::EmulatedDevice> right) : right_(std::move(right)) {}

  net::Host* network() override { return this; }
  Status set(std::string_view address, std::string_view hex) override {
    return right_->set(address, hex);
  }
  Result<std::string> get(std::string_view address, std::size_t digits) const override {
    return right_->get(address, digits);
  }
  Status act(std::string_view action) override { return right_->act(action); }

  bool listens(Transport transport, std::uint16_t port) const override {
    return right_->network()->listens(transport, port);
  }
  void receive(const Burst& burst) override {
    if (burst.event == LinkEvent::opened) open_.insert(burst.link);
    if (burst.event == LinkEvent::closed || burst.event == LinkEvent::reset)
      open_.erase(burst.link);
    right_->network()->receive(burst);
  }
  std::optional<Time> wake_at() const override { return right_->network()->wake_at(); }
  std::vector<Burst> advance(Time now) override {
    std::vector<Burst> done = right_->network()->advance(now);
    for (Burst& burst : done)
      if (burst.event == LinkEvent::reset)
        open_.erase(burst.link);
      else if (burst.event == LinkEvent::data && !open_.empty())
        burst.link = *open_.begin();
    return done;
  }

 private:
  std::unique_ptr<plc::EmulatedDevice> right_;
  std::set<LinkId> open_;
};

TEST(Explorer, ConnectionsThatAreMixedUpAreFound) {
  const Protocol& tcp = protocol("modbus-tcp");
  InProcess device(tcp, wrapped_in<AnswersTheFirst>(tcp));
  Explorer one = explorer(tcp, device, cases("modbus_tcp"));
  while (one.findings().empty() && one.requests_sent() < 3000) one.step();
  ASSERT_FALSE(one.findings().empty());
  const Finding& finding = one.findings().begin()->second;
  const std::string text = vector_text(finding.shortest);
  EXPECT_THAT(finding.shortest.title, HasSubstr("on 2 connections"));
  EXPECT_THAT(text, AllOf(HasSubstr("\"open\": \"c"), HasSubstr("\"on\": \"c")));
  InProcess good(tcp);
  vectors::VectorSet set;
  vectors::load_vector_text(text, "f.json", set, {suites::protocols()});
  EXPECT_THAT(set.problems, IsEmpty());
  ASSERT_EQ(set.cases.size(), 1u);
  EXPECT_EQ(good.run(set.cases.front()).verdict, Verdict::pass);
  EXPECT_EQ(device.run(set.cases.front()).verdict, Verdict::fail);
}

/// Who takes one client at a time says so.
TEST(ServerSequences, GoOverNoMoreConnectionsThanThereAre) {
  const Protocol& tcp = protocol("modbus-tcp");
  const std::string model = tcp.models().front();
  const nlohmann::json one_at_a_time{{"connections", 1}};
  ServerSequences sequences(Server{.protocol = &tcp, .config = one_at_a_time},
                            std::move(*Oracle::open(tcp, model, 1, one_at_a_time)),
                            requests_of(cases("modbus_tcp"), tcp, model), 1);
  for (int i = 0; i < 100; ++i) {
    const Sequence::Own one = sequences.invent();
    if (!one) continue;
    for (const vectors::Step& step : one->as_case("x").steps) EXPECT_EQ(step.on, "");
  }
}

TEST(Explorer, TheSameFaultIsOneFinding) {
  const Protocol& cnet = protocol("xgt-cnet");
  InProcess device(cnet, wrapped_in<OneCodeForAnother>(cnet));
  Explorer one = explorer(cnet, device, cases("xgt_cnet"));
  while (one.requests_sent() < 1500) one.step();
  ASSERT_EQ(other_sorts(one), 1) << marks(one);
  EXPECT_GT(one.findings().begin()->second.shown_by.size(), 1u);
}

/// Two faults of one topic are two.
class TwoFaults : public Answering {
 public:
  using Answering::Answering;

 private:
  Bytes changed(Bytes reply) override {
    const std::string text = to_text(reply);
    if (is_nak(reply) && text.find("1132") == 6) return with_code(std::move(reply), "0011");
    if (is_nak(reply) && text.find("0003") == 6) return with_code(std::move(reply), "0004");
    return reply;
  }
};

TEST(Explorer, TwoFaultsAreTwoFindings) {
  const Protocol& cnet = protocol("xgt-cnet");
  InProcess device(cnet, wrapped_in<TwoFaults>(cnet));
  Explorer one = explorer(cnet, device, cases("xgt_cnet"));
  while (one.requests_sent() < 1500) one.step();
  EXPECT_EQ(other_sorts(one), 2) << marks(one);
}

/// Reads what the manuals leave open in its own way, and always so.
class Stranger : public Answering {
 public:
  using Answering::Answering;

 private:
  Bytes changed(Bytes reply) override {
    return is_nak(reply) && to_text(reply).find("0011") == 6 && !printed(reply)
               ? with_code(std::move(reply), "7777")
               : reply;
  }
  /// Vectors have 0011 for their own requests; one here has a command of small letters.
  static bool printed(const Bytes& reply) { return std::isupper(reply[3]) != 0; }
};

TEST(Explorer, WhatNobodySaysIsLearnt) {
  const Protocol& cnet = protocol("xgt-cnet");
  InProcess device(cnet, wrapped_in<Stranger>(cnet), false);
  Explorer one = explorer(cnet, device, cases("xgt_cnet"), 1, Server{.learns = true});
  while (one.requests_sent() < 3000) one.step();
  EXPECT_THAT(one.known().readings, Contains(HasSubstr("7777 on the device")));
  for (const auto& [mark, finding] : one.findings())
    EXPECT_THAT(mark, Not(HasSubstr("before, then")))
        << finding.result.message << vector_text(finding.shortest);
}

/// What it answers to the same depends on how often it was asked anything.
class Fickle : public Answering {
 public:
  using Answering::Answering;

 private:
  Bytes changed(Bytes reply) override {
    return ++count_ % 3 == 0 && is_nak(reply) ? with_code(std::move(reply), "7777") : reply;
  }
  int count_ = 0;
};

TEST(Explorer, ADeviceThatContradictsItselfFails) {
  const Protocol& cnet = protocol("xgt-cnet");
  InProcess device(cnet, wrapped_in<Fickle>(cnet), false);
  Explorer one = explorer(cnet, device, cases("xgt_cnet"), 1, Server{.learns = true});
  const auto contradiction = [&] {
    return std::ranges::find_if(one.findings(), [](const auto& each) {
      return each.first.find("before, then") != std::string::npos;
    });
  };
  while (contradiction() == one.findings().end() && one.requests_sent() < 20000) one.step();
  ASSERT_NE(contradiction(), one.findings().end());
  const Finding& finding = contradiction()->second;
  EXPECT_EQ(finding.result.verdict, Verdict::fail);
  EXPECT_EQ(finding.result.section, as_before_decision);
}

/// Somebody has registered each monitor before.
class Registered : public broken::WrappedDevice {
 public:
  using WrappedDevice::WrappedDevice;
  void receive(const Burst& burst) override {
    if (!std::exchange(registered_, true)) register_all(burst);
    WrappedDevice::receive(burst);
  }

 private:
  void register_all(const Burst& burst) {
    Time now = burst.start - 100s;
    for (int number = 0; number < 16; ++number, now += 1s) {
      const std::string text = fmt::format(
          "\x05"
          "01X{:02X}RSS0106%MW000\x04",
          number);
      WrappedDevice::receive({to_bytes(text), now, burst.character_time});
      while (const auto wake = wake_at()) (void)WrappedDevice::advance(*wake);
    }
  }
  bool registered_ = false;
};

TEST(Explorer, WhatOthersRegisteredIsNoFinding) {
  const Protocol& cnet = protocol("xgt-cnet");
  InProcess device(cnet, wrapped_in<Registered>(cnet));
  Explorer one = explorer(cnet, device, cases("xgt_cnet"), 1, Server{.over_the_wire = true});
  while (one.requests_sent() < 1500) one.step();
  EXPECT_THAT(one.findings(), IsEmpty()) << one.findings().begin()->second.result.message;
}

/// A device over the wire is given no more than the answers depend on.
TEST(Explorer, AFindingGivesNoMoreThanItTakes) {
  const Protocol& cnet = protocol("xgt-cnet");
  InProcess device(cnet, wrapped_in<OneCodeForAnother>(cnet));
  Explorer one = explorer(cnet, device, cases("xgt_cnet"), 1, Server{.over_the_wire = true});
  while (one.findings().empty() && one.requests_sent() < 3000) one.step();
  ASSERT_THAT(one.findings(), Not(IsEmpty()));
  EXPECT_THAT(one.findings().begin()->second.shortest.memory, IsEmpty());
}

/// A refusal that a vector has is what that rests on.
TEST(Explorer, AFindingCitesItsClause) {
  const Protocol& cnet = protocol("xgt-cnet");
  InProcess device(cnet, wrapped_in<OneCodeForAnother>(cnet));
  Explorer one = explorer(cnet, device, cases("xgt_cnet"));
  while (one.findings().empty() && one.requests_sent() < 3000) one.step();
  ASSERT_THAT(one.findings(), Not(IsEmpty()));
  EXPECT_THAT(one.findings().begin()->second.result.section, Not(HasSubstr("own-model")));
}

/// Refuses now and then what it should grant.
class Flighty : public Answering {
 public:
  using Answering::Answering;
  Bytes changed(Bytes reply) override {
    if (++count_ % 40 == 0 && !is_nak(reply)) reply.front() = 0x15;
    return reply;
  }

 private:
  inline static int count_ = 0;  // of all devices
};

TEST(Explorer, WhatIsSeenOnceIsInconclusive) {
  const Protocol& cnet = protocol("xgt-cnet");
  InProcess device(cnet, wrapped_in<Flighty>(cnet));
  Explorer one = explorer(cnet, device, cases("xgt_cnet"));
  while (one.findings().empty() && one.requests_sent() < 3000) one.step();
  ASSERT_THAT(one.findings(), Not(IsEmpty()));
  const Finding& finding = one.findings().begin()->second;
  EXPECT_FALSE(finding.confirmed);
  EXPECT_EQ(finding.result.verdict, Verdict::inconclusive);
  EXPECT_THAT(finding.result.message, HasSubstr("seen once"));
}

TEST(Explorer, MapsWhatTheDeviceDoes) {
  const Protocol& cnet = protocol("xgt-cnet");
  InProcess device(cnet);
  Explorer one = explorer(cnet, device, cases("xgt_cnet"));
  const auto mapped =
      AllOf(Contains(HasSubstr("SS, block count: 1 to 16 accepted, 17 refused with 0003")),
            Contains(HasSubstr("area M: ")));
  while (one.requests_sent() < 20'000 && !testing::Matches(mapped)(one.known().limits)) one.step();
  EXPECT_THAT(one.known().limits, mapped) << testing::PrintToString(one.known().limits);
}

Explorer client_explorer(const Protocol& own, const std::string& model, InProcess& device,
                         const std::vector<Case>& from) {
  auto made = ClientSequences::open({&own, model}, client_pool(from, own, model), 3);
  return Explorer({&own, [&device](const Case& one) { return device.run(one); }}, std::move(*made));
}

struct Asking {
  const char *protocol, *folder, *model;
};

class HealthyClients : public testing::TestWithParam<Asking> {};

TEST_P(HealthyClients, ShowNothing) {
  const Protocol& own = protocol(GetParam().protocol);
  InProcess device(own);
  Explorer one = client_explorer(own, GetParam().model, device, cases(GetParam().folder));
  while (one.requests_sent() < 150) one.step();
  EXPECT_THAT(one.findings(), IsEmpty()) << one.findings().begin()->second.result.message;
  EXPECT_EQ(one.judged(), one.sequences());
  EXPECT_GT(one.seen().size(), 8u);
}

INSTANTIATE_TEST_SUITE_P(Explorer, HealthyClients,
                         testing::Values(Asking{"xgt-cnet", "xgt_cnet", "xbc-h"},
                                         Asking{"modbus-rtu", "modbus_rtu", "xbc-h"},
                                         Asking{"modbus-tcp", "modbus_tcp", "xbc-h"},
                                         Asking{"xgt-fenet", "xgt_fenet", "xbc-h"},
                                         Asking{"ls-bus", "ls_bus", "xbc-h"}),
                         [](const auto& one) { return std::string(one.param.folder); });

/// What devices may choose: numbers of requests, what they say of their CPU, checks of these.
TEST(ClientPool, LeavesOpenWhatVectorsLeaveOpen) {
  const auto open = [](const char* name, const char* folder) {
    return client_pool(cases(folder), protocol(name), "xbc-h").open;
  };
  EXPECT_THAT(open("xgt-fenet", "xgt_fenet"), testing::ElementsAre(10, 11, 12, 14, 15, 18, 19));
  EXPECT_THAT(open("modbus-tcp", "modbus_tcp"), testing::ElementsAre(0, 1, 6));
  EXPECT_THAT(open("xgt-cnet", "xgt_cnet"), IsEmpty());
}

/// A program is told of one flag after another.
TEST(ClientSequences, FireOneBlockAtATimeOverTheWire) {
  const Protocol& cnet = protocol("xgt-cnet");
  const auto made = ClientSequences::open({&cnet, "xbc-h", true},
                                          client_pool(cases("xgt_cnet"), cnet, "xbc-h"), 3);
  ASSERT_TRUE(made);
  for (int i = 0; i < 100; ++i) {
    const Sequence::Own sequence = (*made)->invent();
    for (std::size_t part = 0; sequence && part < sequence->parts(); ++part)
      EXPECT_NE(sequence->topic(part).kind, "at once");
  }
}

/// Each sixth request is not sent.
class Tired : public broken::WrappedDevice {
 public:
  using WrappedDevice::WrappedDevice;
  Bytes advance(Time now) override {
    Bytes bytes = WrappedDevice::advance(now);
    return !bytes.empty() && ++count_ % 6 == 0 ? Bytes{} : bytes;
  }

 private:
  int count_ = 0;
};

TEST(Explorer, AFindingOfAClientIsAVector) {
  const Protocol& cnet = protocol("xgt-cnet");
  InProcess device(cnet, wrapped_in<Tired>(cnet));
  Explorer one = client_explorer(cnet, "xbc-h", device, cases("xgt_cnet"));
  while (one.findings().empty() && one.requests_sent() < 5000) one.step();
  ASSERT_THAT(one.findings(), Not(IsEmpty()));
  const Finding& finding = one.findings().begin()->second;
  EXPECT_TRUE(finding.confirmed);
  vectors::VectorSet set;
  vectors::load_vector_text(vector_text(finding.shortest), "finding.json", set,
                            {suites::protocols()});
  EXPECT_THAT(set.problems, IsEmpty());
  ASSERT_EQ(set.cases.size(), 1u);
  const auto requests = std::ranges::count(set.cases.front().steps, vectors::Step::Kind::expect,
                                           &vectors::Step::kind);
  EXPECT_LE(requests, 6);
  EXPECT_EQ(device.run(set.cases.front()).verdict, Verdict::fail);
  InProcess good(cnet);
  const CaseResult healthy = good.run(set.cases.front());
  EXPECT_EQ(healthy.verdict, Verdict::pass) << healthy.message;
}

}  // namespace
}  // namespace fieldproof::explore
