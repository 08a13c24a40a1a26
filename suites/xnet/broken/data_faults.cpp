#include "suites/xnet/broken/rewrites.hpp"

namespace fieldproof::xnet_broken {

namespace {

void count_less(Words& words, std::size_t) {
  behind(words, "count", [](long count) { return std::max(count - 1, 0L); });
}
void count_more(Words& words, std::size_t) {
  behind(words, "count", [](long count) { return count + 1; });
}
void clip_words(Words& words, std::size_t) {
  behind(words, "count", [](long count) { return std::min(count, 125L); });
}
void clip_bits(Words& words, std::size_t) {
  behind(words, "count", [](long count) { return std::min(count, 2000L); });
}
void none_is_one(Words& words, std::size_t) {
  behind(words, "count", [](long count) { return std::max(count, 1L); });
}
void next_station(Words& words, std::size_t) {
  behind(words, "station", [](long station) { return station + 1; });
}
void any_net(Words& words, std::size_t) {
  behind(words, "net", [](long) { return 1L; });
}
void net_bytes_swapped(Words& words, std::size_t) {
  const auto found = std::ranges::find(words, "net");
  if (found != words.end() && found[1].size() == 6 && found[1][0] == 'H')
    found[1] = "H0" + found[1].substr(4) + found[1].substr(2, 2);
}
void writes_for_reads(Words& words, std::size_t head) {
  words[head] = "REG_WRITE";
  std::ranges::replace(words, std::string("to"), std::string("from"));
}
void twice_as_far(Words& words, std::size_t) {
  std::string& local = words.back();
  const Name name = split(local);
  local = fmt::format("{}{}", name.area, name.number + 1);
}
/// The word that names the target.
template <typename Change>
void target(Words& words, Change change) {
  const auto count = std::ranges::find(words, "count");
  if (count == words.begin() || count == words.end() || is_number(count[-1])) return;
  count[-1] = change(count[-1]);
}
void target_next(Words& words, std::size_t) {
  target(words, [](const std::string& text) {
    const Name name = split(text);
    return fmt::format("{}{}", name.area, name.number + 1);
  });
}
void no_h(Words& words, std::size_t) {
  target(words,
         [](const std::string& text) { return text.starts_with('H') ? text.substr(1) : text; });
}
/// X10 is the tenth, not the eighth.
void decimal_inputs(Words& words, std::size_t head) {
  for (std::size_t i = head; i < words.size(); ++i)
    if (words[i].size() > 2 && (words[i][0] == 'X' || words[i][0] == 'Y') &&
        is_number(words[i].substr(1)))
      words[i] = fmt::format("{}{:o}", words[i][0], std::min(std::stol(words[i].substr(1)), 63L));
}
void level(Words& words, std::size_t head) {
  if (head == 0) words.insert(words.begin(), "hold");
}

/// What is done twice; what is held only once.
Behaviour twice() {
  return {.act = [](const std::string& action, const Look&, const Put&) {
    const bool data = is(words_of(action), "REG_") || is(words_of(action), "BIT_");
    return data ? Words{action, action} : Words{action};
  }};
}
Behaviour edge_for_level() {
  return {.act = [](const std::string& action, const Look&, const Put&) {
    return Words{action.starts_with("hold ") ? action.substr(5) : action};
  }};
}
Behaviour all_late() { return {.late = 250ms}; }

Behaviour bytes_swapped() {
  return {.value = [](const std::string& text, const std::string& hex) {
    if (split(text).area != "D") return hex;
    std::string turned = hex;
    for (std::size_t at = 0; at + 4 <= hex.size(); at += 4)
      turned.replace(at, 4, hex.substr(at + 2, 2) + hex.substr(at, 2));
    return turned;
  }};
}
Behaviour turns_backwards() {
  return {.value = [](const std::string& text, const std::string& hex) {
    if (text != "@turns") return hex;
    std::string turned;
    for (std::size_t at = 0; at + 2 <= hex.size(); at += 2) turned.insert(0, hex.substr(at, 2));
    return turned;
  }};
}
Behaviour one_keeps_the_token() {
  return {.value = [](const std::string& text, const std::string& hex) {
    if (text != "@turns" || hex.size() < 4) return hex;
    return hex.substr(0, 2) + hex.substr(0, 2) + hex.substr(4);
  }};
}

// ---- configuration ----

Make ports(void (*change)(json& port)) {
  return [=] {
    return Behaviour{.config = [change](json& config) {
      const auto all = [change](json& plc) {
        if (plc.contains("ports"))
          for (json& port : plc["ports"]) change(port);
      };
      all(config);
      if (config.contains("stations"))
        for (json& other : config["stations"]) all(other);
    }};
  };
}
void slow_cycle(json& port) { port["cycle_ms"] = 500; }
void slow_line(json& port) { port["baud"] = 9600; }
Behaviour without_routes() {
  return {.config = [](json& config) { config.erase("routes"); }};
}
}  // namespace

/// Of nets, data instructions, results and counters.
std::vector<Fault> data_faults() {
  return {
      {"reg_read_count_one_less", "REG_READ moves one object less", tells("REG_READ", count_less),
       "xnet/instruction_data/accessed", "SD161"},
      {"reg_write_count_one_less", "REG_WRITE moves one object less",
       tells("REG_WRITE", count_less), "xnet/instruction_data/each_is_master", "B:D100"},
      {"bit_read_count_one_less", "BIT_READ moves one object less", tells("BIT_READ", count_less),
       "xnet/instruction_data/bit_read", "M100"},
      {"bit_write_count_one_less", "BIT_WRITE moves one object less",
       tells("BIT_WRITE", count_less), "xnet/instruction_data/bit_write", "B:M20"},
      {"count_one_more", "an instruction moves one object more", tells("", count_more),
       "xnet/instruction_data/address", "D0"},
      {"words_to_126", "takes 126 words as 125", tells("REG_", clip_words),
       "xnet/instruction_data/s5_none_or_too_many/reg_read_126", "SD161"},
      {"bits_to_2001", "takes 2001 bits as 2000", tells("BIT_", clip_bits),
       "xnet/instruction_data/s5_none_or_too_many/bit_read_2001", "SD161"},
      {"count_0_is_1", "takes a count of 0 for 1", tells("", none_is_one),
       "xnet/instruction_data/s5_none_or_too_many/bit_read_0", "SD161"},
      {"next_station", "asks the next station", tells("", next_station),
       "xnet/instruction_data/accessed", "D100"},
      {"any_net", "whatever the net, asks net 1", tells("", any_net),
       "xnet/configuration_nets/ethernet_30_reads", "D10"},
      {"net_bytes_swapped", "the two bytes of an address that make the net are swapped",
       tells("", net_bytes_swapped), "xnet/instruction_ethernet/coil_types/hm", "M100"},
      {"writes_for_reads", "REG_READ writes", tells("REG_READ", writes_for_reads),
       "xnet/instruction_data/accessed", "D100"},
      {"local_one_further", "the local object is one further on", tells("REG_", twice_as_far),
       "xnet/instruction_data/accessed", "D100"},
      {"local_bit_further", "the local coil is one further on", tells("BIT_", twice_as_far),
       "xnet/instruction_data/app1_all", "B:M50"},
      {"target_one_further", "the target's object is one further on", tells("", target_next),
       "xnet/instruction_data/accessed", "D100"},
      {"h_left_out", "HD and HM are D and M", tells("", no_h),
       "xnet/instruction_data/count_example", "D0"},
      {"level_for_edge", "an edge executes again and again", tells("", level),
       "xnet/instruction_ethernet/annular", "SD194"},
      {"edge_for_level", "a condition that stays on executes once", edge_for_level,
       "xnet/instruction_ethernet/held", "B:D0"},
      {"executed_twice", "an edge executes twice", twice, "xnet/instruction_ethernet/annular",
       "SD194"},
      {"late", "everything is done 250 ms late", all_late, "xnet/timing_ethernet/two_ms", "SD194"},
      {"release_ignored", "goes on when the condition is off", ignores("release"),
       "xnet/instruction_ethernet/held", "B:D0"},
      {"runs_in_stop", "executes in STOP", ignores("stop"), "xnet/instruction_protection/plc_stop",
       "SD2010"},
      {"noise_unnoticed", "a damaged transfer is taken", ignores("noise on"),
       "xnet/register_results/crc_bit_read", "SD161"},
      {"power_stays", "a station stays when its power is off", ignores("off"),
       "xnet/register_results/port_0_crc", "SD141"},
      {"bytes_swapped", "the bytes of D are swapped", bytes_swapped,
       "xnet/instruction_data/accessed", "D100"},
      {"result_of_the_next_port", "results lie in the registers of the next port",
       moved("SD", 141, 189, 10), "xnet/register_results/crc_bit_read", "SD161"},
      {"result_always_0", "the result is always 0", sees("SD", 141, 192, "", "0000"),
       "xnet/register_results/crc_bit_read", "SD161"},
      {"overtime_as_memory", "a time-out is told as memory error",
       sees("SD", 141, 192, "0001", "0002"), "xnet/register_results/five_ports", "SD161"},
      {"memory_as_overtime", "a memory error is told as time-out",
       sees("SD", 141, 192, "0002", "0001"), "xnet/register_results/five_ports", "SD171"},
      {"crc_as_overtime", "a damaged transfer is told as time-out",
       sees("SD", 141, 192, "0003", "0001"), "xnet/register_results/crc_bit_read", "SD161"},
      {"presence_one_further", "presence relays lie one further on", moved("SM", 1200, 1799, 1),
       "xnet/register_results/present_32", "SM1401"},
      {"presence_of_the_next_port", "presence relays lie with the next port",
       moved("SM", 1200, 1699, 100), "xnet/register_results/present_32", "SM1401"},
      {"presence_always", "every station is there", sees("SM", 1200, 1799, "", "01"),
       "xnet/register_results/present_32", "SM1401"},
      {"presence_never", "no station is there", sees("SM", 1200, 1799, "", "00"),
       "xnet/register_results/present_32", "SM1401"},
      {"turns_backwards", "stations have the token in the other order", turns_backwards,
       "xnet/timing_token/by_number", "@turns"},
      {"token_kept", "a station has the token twice", one_keeps_the_token,
       "xnet/timing_token/by_number", "@turns"},
      {"cycle_of_500_ms", "the token takes 500 ms to come round", ports(slow_cycle),
       "xnet/timing_token/all_within_a_cycle", "C:D10"},
      {"slow_line", "the bus runs at 9600 bit/s", ports(slow_line), "xnet/instruction_data/count",
       "SD161"},
      {"no_routes", "the route table is not read", without_routes,
       "xnet/instruction_ethernet/gateway", "D10"},
      {"failures_count_all", "SD196 counts every instruction", moved("SD", 196, 196, -2),
       "xnet/instruction_ethernet/coil_types/hm", "SD196"},
      {"overtimes_count_failures", "SD198 counts every failure", moved("SD", 198, 198, -2),
       "xnet/instruction_ethernet/wrong_type/coil_in_reg_read", "SD198"},
      {"instructions_not_counted", "SD194 stays 0", sees("SD", 194, 194, "", "0000"),
       "xnet/instruction_ethernet/annular", "SD194"},
      {"net_and_station_swapped", "SD1905 shows the station", moved("SD", 1905, 1905, 1),
       "xnet/register_ethernet/address/high", "SD1905"},
      {"inputs_in_decimal", "X and Y are numbered in decimal", tells("", decimal_inputs),
       "xnet/instruction_octal/coils", "M0"},
  };
}

}  // namespace fieldproof::xnet_broken
