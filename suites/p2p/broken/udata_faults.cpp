// The UDATA instructions (Cnet KO 6.6).
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
      {"udata_in_stop", "instructions run in STOP", [] { return Behaviour{.deaf_to = "stop"}; },
       "udata/send/in_stop", "where silence is due"},
  };
}

}  // namespace fieldproof::p2p_broken
