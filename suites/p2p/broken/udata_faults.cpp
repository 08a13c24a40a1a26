// The UDATA instructions (Cnet KO 6.6).
#include <algorithm>

#include "suites/p2p/broken/faults.hpp"

namespace fieldproof::p2p_broken {

using udata::UdataConfig;
using udata::UdataInstruction;

namespace {

using Operation = UdataInstruction::Operation;

MakeBehaviour udata(std::function<void(UdataConfig& config)> edit) {
  return [=] { return Behaviour{.works_with_udata = edit}; };
}

MakeBehaviour each_instruction(std::function<void(UdataInstruction& instruction)> edit) {
  return udata([=](UdataConfig& config) { std::ranges::for_each(config.instructions, edit); });
}

MakeBehaviour says(std::function<void(Bytes& bytes)> edit) {
  return [=] { return Behaviour{.says = edit}; };
}

MakeBehaviour udata_hears(std::function<void(Bytes& bytes)> edit) {
  return [=] { return Behaviour{.hears = edit}; };
}

void swap_bytes(Bytes& bytes) {
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) std::swap(bytes[i], bytes[i + 1]);
}

void any_module(UdataConfig& config) {
  for (UdataInstruction& instruction : config.instructions) instruction.slot = config.module.slot;
}

void answers_at_once(UdataConfig& config) { config.module.hangs = false; }

void any_base(UdataInstruction& instruction) { instruction.base = 0; }

/// The channel of the module is meant, whatever is named.
void any_channel(UdataConfig& config) {
  for (UdataInstruction& instruction : config.instructions)
    instruction.channel = {static_cast<std::uint16_t>(config.module.channel)};
}

/// A size that is no size is made the next one that is.
void next_size(UdataInstruction& instruction) {
  std::uint16_t& size = instruction.value.constant;
  if (instruction.operation == Operation::send && !instruction.value.word)
    size = std::clamp(size, std::uint16_t{1}, std::uint16_t{udata::udata_max});
}

/// SIZE is a constant 1, where it stands in memory.
void size_not_read(UdataInstruction& instruction) {
  if (instruction.operation == Operation::send && instruction.value.word) instruction.value = {1};
}

/// A level above 1 is 1.
void any_level_sets(UdataInstruction& instruction) {
  const bool level =
      instruction.operation == Operation::dtr || instruction.operation == Operation::rts;
  if (level && instruction.value.constant > 1) instruction.value.constant = 1;
}

void dtr_for_rts(UdataInstruction& instruction) {
  if (instruction.operation == Operation::dtr)
    instruction.operation = Operation::rts;
  else if (instruction.operation == Operation::rts)
    instruction.operation = Operation::dtr;
}

}  // namespace

std::vector<Fault> udata_faults() {
  return {
      {"udata_one_byte_less", "the last byte is not sent",
       says([](Bytes& bytes) { bytes.pop_back(); }), "udata/send/size_10", "data: expected"},
      {"udata_bytes_swapped", "of a word the high byte is sent first", says(swap_bytes),
       "udata/send/byte_order", "data: expected"},
      {"udata_stored_swapped", "of a word the high byte is stored first", udata_hears(swap_bytes),
       "udata/receive/byte_order", "%DW300 holds BC5AEF12"},
      {"udata_stores_one_byte_less", "the last byte that was received is lost",
       udata_hears([](Bytes& bytes) { bytes.pop_back(); }), "udata/receive/size_7",
       "%DB600 holds 00FF0D0A807FE7E8"},
      {"udata_data_from_next_byte", "data are taken and stored one byte too high",
       each_instruction(
           [](UdataInstruction& instruction) { instruction.data = instruction.data + 1; }),
       "udata/send/size_10", "data: expected"},
      {"udata_seven_bits", "the top bit of what is sent is lost", says([](Bytes& bytes) {
         for (Byte& byte : bytes) byte &= 0x7F;
       }),
       "udata/send/byte_order", "data: expected"},
      {"udata_old_module", "a module older than V1.4 works, too",
       udata([](UdataConfig& config) { config.module.new_enough = true; }),
       "udata/status/senddtr_version_1_3", "%DW200 holds 0001"},
      {"udata_built_in_is_old", "the built-in Cnet has the version of no module, and is too old",
       udata([](UdataConfig& config) {
         if (config.module.slot == 0) config.module.new_enough = false;
       }),
       "udata/status/senddtr_built_in", "%DW200 holds 0007"},
      {"udata_any_driver", "the driver of the channel does not matter",
       udata([](UdataConfig& config) { config.module.user_frames = true; }),
       "udata/status/senddtr_driver", "%DW200 holds 0001"},
      {"udata_without_link", "the link need not be enabled",
       udata([](UdataConfig& config) { config.module.link = true; }), "udata/status/senddtr_link",
       "%DW200 holds 0001"},
      {"udata_any_slot", "the slot that an instruction names does not matter", udata(any_module),
       "udata/status/senddtr_slot", "%DW200 holds 0001000000000000"},
      {"udata_dtr_for_rts", "SENDDTR moves RTS, and SENDRTS DTR", each_instruction(dtr_for_rts),
       "udata/levels/dtr_set_and_clear", "@dtr holds 00"},
      {"udata_any_module", "a module that is no Cnet takes instructions",
       udata([](UdataConfig& config) { config.module.cnet = true; }),
       "udata/status/senddtr_no_cnet", "%DW200 holds 0001"},
      {"udata_any_base", "the base that an instruction names does not matter",
       each_instruction(any_base), "udata/iec/send_dtr_base", "%MX1 holds 01"},
      {"udata_any_channel", "the channel that an instruction names does not matter",
       udata(any_channel), "udata/status/unused_channel", "where silence is due"},
      {"udata_time_out_unnoticed", "a module that does not answer is taken for one that does",
       udata(answers_at_once), "udata/status/senddtr_hangs", "%DW200 holds 0001"},
      {"udata_size_made_fit", "a size of 0 is 1, one above 1024 is 1024",
       each_instruction(next_size), "udata/send/size_constant_0", "where silence is due"},
      {"udata_size_not_read", "SIZE in memory is taken for 1", each_instruction(size_not_read),
       "udata/status/hangs_and_size", "%DW200 holds"},
      {"udata_any_level_sets", "a level of 2 sets the line, too", each_instruction(any_level_sets),
       "udata/levels/dtr_constant_2", "%DW220 holds 0001"},
      {"udata_power_changes_nothing", "what is under way outlives the power",
       [] { return Behaviour{.deaf_to = "power_cycle"}; }, "udata/power/time_out",
       "%DW200 holds 0006"},
      {"udata_in_stop", "instructions run in STOP", [] { return Behaviour{.deaf_to = "stop"}; },
       "udata/send/in_stop", "where silence is due"},
  };
}

}  // namespace fieldproof::p2p_broken
