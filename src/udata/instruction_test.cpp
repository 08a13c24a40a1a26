#include "src/udata/instruction.hpp"

#include <gtest/gtest.h>

namespace fieldproof::udata {
namespace {

using Operation = UdataInstruction::Operation;

const plc::PlcModel& xbc() { return *plc::find_plc_model("xbc-h"); }
plc::DeviceAddress at(std::string_view name) { return plc::parse_address(xbc(), name).address; }

/// Sends 10 bytes from D100 on by the RS-232C channel of a module in slot 1.
UdataInstruction sending() {
  UdataInstruction one;
  one.slot = 1;
  one.channel.constant = 2;
  one.value.constant = 10;
  one.data = at("%DB200");
  one.status = at("%DW300");
  return one;
}

std::uint16_t checked(const UdataInstruction& instruction, const UdataModule& module = {}) {
  return check_udata(instruction, module, plc::PlcMemory(xbc()));
}

TEST(UdataInstruction, HasNothingInItsWay) { EXPECT_EQ(checked(sending()), udata_status::done); }

TEST(UdataInstruction, MissesAModuleThatIsElsewhereOrNoCnet) {
  UdataInstruction one = sending();
  one.slot = 2;
  EXPECT_EQ(checked(one), udata_status::module);
  EXPECT_TRUE(misses_module(one, {}));
  one = sending();
  one.base = 1;
  EXPECT_EQ(checked(one), udata_status::module);
  UdataModule emta;
  emta.cnet = false;
  EXPECT_EQ(checked(sending(), emta), udata_status::module);
  EXPECT_FALSE(misses_module(sending(), {}));
}

TEST(UdataInstruction, TakesChannelOneOrTwo) {
  for (const auto& [channel, status] : {std::pair{0, udata_status::channel},
                                        {1, udata_status::parameters},
                                        {2, udata_status::done},
                                        {3, udata_status::channel}}) {
    UdataInstruction one = sending();
    one.channel.constant = static_cast<std::uint16_t>(channel);
    EXPECT_EQ(checked(one), status) << channel;
  }
}

TEST(UdataInstruction, SendsOneTo1024Bytes) {
  for (const auto& [size, status] : {std::pair{0, udata_status::value},
                                     {1, udata_status::done},
                                     {1024, udata_status::done},
                                     {1025, udata_status::value}}) {
    UdataInstruction one = sending();
    one.value.constant = static_cast<std::uint16_t>(size);
    EXPECT_EQ(checked(one), status) << size;
  }
}

TEST(UdataInstruction, DoesNotSendBeyondTheEndOfItsArea) {
  UdataInstruction one = sending();
  one.data = at("%MB2040");  // M of xbc-h ends at byte 2047
  one.value.constant = 8;
  EXPECT_EQ(checked(one), udata_status::done);
  one.value.constant = 9;
  EXPECT_EQ(checked(one), udata_status::value);
}

TEST(UdataInstruction, LevelsAreZeroAndOne) {
  for (const Operation operation : {Operation::dtr, Operation::rts}) {
    UdataInstruction one = sending();
    one.operation = operation;
    one.value.constant = 2;
    EXPECT_EQ(checked(one), udata_status::value);
    one.value.constant = 1;
    EXPECT_EQ(checked(one), udata_status::done);
  }
}

TEST(UdataInstruction, NeedsUserFramesLinkAndVersion) {
  UdataModule other, unlinked, old;
  other.user_frames = false;
  unlinked.link = false;
  old.new_enough = false;
  EXPECT_EQ(checked(sending(), other), udata_status::parameters);
  EXPECT_EQ(checked(sending(), unlinked), udata_status::parameters);
  EXPECT_EQ(checked(sending(), old), udata_status::version);
}

TEST(UdataInstruction, TellsTheFirstOfSeveralFaults) {
  UdataInstruction one = sending();
  UdataModule module;
  module.new_enough = module.link = false;
  EXPECT_EQ(checked(one, module), udata_status::parameters);
  one.value.constant = 0;
  EXPECT_EQ(checked(one, module), udata_status::value);
  one.channel.constant = 3;
  EXPECT_EQ(checked(one, module), udata_status::channel);
  one.slot = 7;
  EXPECT_EQ(checked(one, module), udata_status::module);
}

TEST(UdataInstruction, ReadsOperandsFromMemory) {
  plc::PlcMemory memory(xbc());
  UdataInstruction one = sending();
  one.value.word = at("%DW50");
  EXPECT_EQ(check_udata(one, {}, memory), udata_status::value);
  memory.write(at("%DW50"), 3);
  EXPECT_EQ(check_udata(one, {}, memory), udata_status::done);
}

TEST(UdataInstruction, BytesOfAWordGoLowFirst) {
  plc::PlcMemory memory(xbc());
  memory.write(at("%DW100"), 0x4241);
  memory.write(at("%DW101"), 0x9943);
  UdataInstruction one = sending();
  one.value.constant = 3;
  EXPECT_EQ(to_text(read_data(one, memory)), "ABC");
}

TEST(UdataInstruction, StoresDataAndSizeAndLeavesTheRestOfTheLastWord) {
  plc::PlcMemory memory(xbc());
  memory.write(at("%DW101"), 0x9988);
  UdataInstruction one = sending();
  one.size = at("%DW90");
  put_data(one, to_bytes("ABC"), memory);
  EXPECT_EQ(memory.read(at("%DW100")), 0x4241u);
  EXPECT_EQ(memory.read(at("%DW101")), 0x9943u);
  EXPECT_EQ(memory.read(at("%DW90")), 3u);
}

}  // namespace
}  // namespace fieldproof::udata
