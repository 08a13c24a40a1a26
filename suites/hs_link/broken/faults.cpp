#include <algorithm>
#include <nlohmann/json.hpp>

#include "harness/exchange/prepared_case.hpp"
#include "suites/hs_link/broken/broken_network.hpp"

namespace fieldproof::hs_link_broken {

namespace {

using exchange::number_of;
using nlohmann::json;

// Bits of link 1 in L (FEnet EN Appendix A.4).
constexpr unsigned rlink = 0, ltrbl = 1, state = 32, mod = 96, trx = 160, err = 224, setblock = 288,
                   arrays_end = 352, array = 64;

const char* as_bit(bool on) { return on ? "01" : "00"; }
bool is_in(unsigned bit, unsigned first) { return bit >= first && bit < first + array; }

using Make = std::function<Behaviour()>;

/// The parameter of the first station; or what it has of each block that is received.
Make other_parameter(void (*change)(json&)) {
  return [=] {
    return Behaviour{.config = [change](json& config) {
      if (config.contains("hs_link")) change(config["hs_link"]);
    }};
  };
}
Make other_blocks(void (*change)(json&)) {
  return [=] {
    return Behaviour{.config = [change](json& config) {
      if (!config.contains("hs_link")) return;
      for (json& block : config["hs_link"]["blocks"])
        if (block["mode"] == "receive") change(block);
    }};
  };
}

void period_doubled(json& own) { own["period_ms"] = number_of(own, "period_ms", 200) * 2; }
void other_link(json& own) { own["link"] = 3 - number_of(own, "link", 1); }
void enabled(json& own) { own["enable"] = true; }
void sort_blocks(json& own) {
  std::stable_sort(own["blocks"].begin(), own["blocks"].end(), [](const json& a, const json& b) {
    return number_of(a, "block", 0) < number_of(b, "block", 0);
  });
}
/// What is sent is taken from station 2 as well.
void takes_what_it_sends(json& own) {
  json taken = json::array();
  for (json block : own["blocks"])
    if (block["mode"] == "send") {
      block["mode"] = "receive";
      block["station"] = 2;
      taken.push_back(block);
    }
  for (const json& block : taken) own["blocks"].push_back(block);
}
void shorter(json& block) { block["size"] = std::max(1, number_of(block, "size", 1) - 1); }
void next_number(json& block) { block["block"] = (number_of(block, "block", 0) + 1) % 64; }
void next_station(json& block) { block["station"] = (number_of(block, "station", 0) + 1) % 64; }

/// The others send at twice their pace.
Behaviour fast_others() {
  return {.config = [](json& config) {
    for (json& other : config["stations"])
      if (other.contains("hs_link"))
        other["hs_link"]["period_ms"] =
            std::max(20, number_of(other["hs_link"], "period_ms", 200) / 2);
  }};
}

/// What is seen of a bit of L.
Make looks(std::string (*bit)(unsigned bit, const Look& look)) {
  return [=] { return Behaviour{.bit = bit}; };
}

/// A bit of an array as another one of it.
Make other_bit(unsigned (*other)(unsigned k)) {
  return [=] {
    return Behaviour{.bit = [other](unsigned bit, const Look& look) {
      if (bit < state || bit >= arrays_end) return look(bit);
      const unsigned k = (bit - state) % array;
      return look(bit - k + other(k));
    }};
  };
}
unsigned reversed_in_word(unsigned k) { return k / 16 * 16 + 15 - k % 16; }
unsigned reversed_words(unsigned k) { return (3 - k / 16) * 16 + k % 16; }
unsigned first_32(unsigned k) { return k % 32; }

/// The bits of one array as a function of those of the right device, by the number of the block.
Make other_flags(unsigned first, bool (*value)(unsigned k, const Look& look)) {
  return [=] {
    return Behaviour{.bit = [=](unsigned bit, const Look& look) {
      return is_in(bit, first) ? std::string(as_bit(value(bit - first, look))) : look(bit);
    }};
  };
}
bool on(const Look& look, unsigned bit) { return look(bit) == "01"; }
bool mod_and_trx(unsigned k, const Look& look) { return on(look, mod + k) && on(look, trx + k); }
bool trx_not_err(unsigned k, const Look& look) { return on(look, trx + k) && !on(look, err + k); }
bool its_trx(unsigned k, const Look& look) { return on(look, trx + k); }
bool its_state(unsigned k, const Look& look) { return on(look, state + k); }
bool its_err(unsigned k, const Look& look) { return on(look, err + k); }
bool never(unsigned, const Look&) { return false; }

std::string rlink_not_latched(unsigned bit, const Look& look) {
  return bit == rlink ? as_bit(on(look, rlink) && !on(look, ltrbl)) : look(bit);
}
std::string trouble_before(unsigned bit, const Look& look) {
  return bit == ltrbl && !on(look, rlink) ? "01" : look(bit);
}
std::string no_trouble(unsigned bit, const Look& look) { return bit == ltrbl ? "00" : look(bit); }
std::string both_swapped(unsigned bit, const Look& look) { return look(bit < 2 ? 1 - bit : bit); }

/// An action that does nothing; or one that does another, too.
Make ignores(const std::string& ignored) {
  return [=] {
    return Behaviour{.act = [=](const std::string& action) {
      return action == ignored ? std::vector<std::string>{} : std::vector{action};
    }};
  };
}
Make adds(const std::string& to, const std::string& other) {
  return [=] {
    return Behaviour{.act = [=](const std::string& action) {
      return action == to ? std::vector{action, other} : std::vector{action};
    }};
  };
}

Make shows(const std::string& instead_of, const std::string& other) {
  return [=] {
    return Behaviour{.show = [=](std::string_view name) {
      return name == instead_of ? other : std::string(name);
    }};
  };
}

}  // namespace

const std::vector<Fault>& faults() {
  static const std::vector<Fault> all{
      {"counts_what_others_send", "packets of blocks that are not registered are counted, too",
       shows("@received", "2:@sent"), "hs_link/diagnosis/packets", "@received"},
      {"packets_of_both_ways", "what is sent is counted as received", shows("@received", "@sent"),
       "hs_link/diagnosis/packets", "@received"},
      {"packets_of_the_other", "what the partner has sent is counted as its own",
       shows("@sent", "2:@sent"), "hs_link/diagnosis/link_off", "@sent"},
      {"period_doubled", "sends and waits at twice its period", other_parameter(period_doubled),
       "hs_link/faults/trx_goes_off/p1000", "%LW10"},
      {"flags_of_the_other_link", "shows the flags of link 1 where those of link 2 are",
       other_parameter(other_link), "hs_link/flags/good", ""},
      {"enabled_whatever_is_set", "the link is enabled whatever the parameter says",
       other_parameter(enabled), "hs_link/flags/disabled_from_the_start", "%LW0"},
      {"blocks_by_number", "the flags are in the order of the blocks' numbers, not of the list",
       other_parameter(sort_blocks), "hs_link/faults/stop", "%LW2"},
      {"takes_what_it_sends", "a block that it sends is taken from others, too",
       other_parameter(takes_what_it_sends), "hs_link/blocks/sending_takes_nothing", "%MW10"},
      {"last_word_lost", "saves one word less of a block", other_blocks(shorter),
       "hs_link/blocks/size/n2", ""},
      {"number_one_more", "takes the block of the next number", other_blocks(next_number),
       "hs_link/blocks/number/b15", ""},
      {"station_one_more", "takes the blocks of the next station", other_blocks(next_station),
       "hs_link/blocks/station_number/s15", ""},
      {"period_halved", "the others send at twice their pace", fast_others,
       "hs_link/periods/not_before/p200", ""},
      {"bits_from_the_left", "block 0 of a word is bit 15", other_bit(reversed_in_word),
       "hs_link/places/mod/link_1/k0", "%LW2"},
      {"words_from_the_end", "the four words of an array are in the other order",
       other_bit(reversed_words), "hs_link/places/trx/link_1/k16", "%LW2"},
      {"flags_of_32_blocks", "block 32 and up show the flags of 32 blocks before",
       other_bit(first_32), "hs_link/flags/setblock_17", "%LW18"},
      {"state_without_err", "STATE does not look at ERR", other_flags(state, mod_and_trx),
       "hs_link/flags/state/run_error", "%LW2"},
      {"state_without_mod", "STATE does not look at MOD", other_flags(state, trx_not_err),
       "hs_link/flags/state/stop", "%LW2"},
      {"state_is_trx", "STATE is TRX alone", other_flags(state, its_trx),
       "hs_link/flags/state/stop_error", "%LW2"},
      {"trx_is_state", "TRX is off for a station in STOP or in error", other_flags(trx, its_state),
       "hs_link/faults/one_of_three/s2_stop", "%LW10"},
      {"mod_is_trx", "MOD does not tell STOP", other_flags(mod, its_trx), "hs_link/faults/stop",
       "%LW6"},
      {"mod_is_err", "MOD and ERR are mixed up", other_flags(mod, its_err), "hs_link/faults/error",
       "%LW6"},
      {"err_never", "ERR is never on", other_flags(err, never), "hs_link/faults/error", "%LW14"},
      {"setblock_is_trx", "SETBLOCK is on only while a block comes", other_flags(setblock, its_trx),
       "hs_link/flags/setblock_disabled", "%LW18"},
      {"rlink_not_latched", "RLINK goes off with the first trouble", looks(rlink_not_latched),
       "hs_link/rlink/latch/stop", "%LX0"},
      {"trouble_before_rlink", "LTRBL is on before RLINK has ever been", looks(trouble_before),
       "hs_link/rlink/no_trouble_before/stop", "%LX1"},
      {"no_trouble", "LTRBL is never on", looks(no_trouble), "hs_link/rlink/trouble_until_the_last",
       "%LX1"},
      {"rlink_and_ltrbl_swapped", "RLINK and LTRBL are at the place of each other",
       looks(both_swapped), "hs_link/rlink/both_sides", "%LX0"},
      {"link_off_ignored", "a disabled link goes on", ignores("link off"), "hs_link/rlink/link_off",
       "%LX0"},
      {"flags_survive_power", "a loss of power loses nothing", ignores("power_cycle"),
       "hs_link/rlink/power_cycle", "%LX0"},
      {"stop_ends_the_exchange", "a station in STOP sends no more",
       adds("station 2 stop", "station 2 off"), "hs_link/faults/trx_in_stop/stop", "%MW100"},
      {"error_ends_the_exchange", "a station in error sends no more",
       adds("station 2 error on", "station 2 off"), "hs_link/faults/trx_in_stop/error", "%MW100"},
      {"error_not_told", "the error of a station is not heard of", ignores("station 2 error on"),
       "hs_link/faults/error", "%LX1"},
      {"stop_not_told", "the STOP of a station is not heard of", ignores("station 2 stop"),
       "hs_link/faults/stop", "%LX1"},
      {"own_stop_disables", "STOP of the station itself disables its link",
       adds("stop", "link off"), "hs_link/faults/own_stop", "%LX0"},
  };
  return all;
}

}  // namespace fieldproof::hs_link_broken
