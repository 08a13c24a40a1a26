#include "src/p2p/registers.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace fieldproof::p2p {

using plc::PlcModel;

namespace {

const PlcModel& mk() { return *plc::find_plc_model("xbc-h"); }
const PlcModel& iec() { return *plc::find_plc_model("xec-h"); }

std::string named(const PlcModel& model, const P2pResultFlags& flags) {
  std::string names;
  for (const plc::DeviceAddress& a :
       {flags.ndr, flags.err, flags.status, flags.services, flags.errors})
    names += device_name(model, a) + ' ';
  return names;
}

// Cnet EN and KO Appendix 2.1 (3). The errors of block 1 are at L522, %LD261: Cnet EN prints
// %LD264.
TEST(P2pResultFlags, PrintedAddresses) {
  EXPECT_EQ(named(mk(), p2p_result_flags(mk(), 1, 0)), "%LX5120 %LX5121 %LW513 %LD257 %LD258 ");
  EXPECT_EQ(named(iec(), p2p_result_flags(iec(), 1, 0)), "%LX8192 %LX8193 %LW513 %LD257 %LD258 ");
  EXPECT_EQ(named(iec(), p2p_result_flags(iec(), 1, 1)), "%LX8288 %LX8289 %LW519 %LD260 %LD261 ");
  EXPECT_EQ(named(mk(), p2p_result_flags(mk(), 1, 31)), "%LX6980 %LX6981 %LW699 %LD350 %LD351 ");
  EXPECT_EQ(named(mk(), p2p_result_flags(mk(), 2, 0)), "%LX7040 %LX7041 %LW705 %LD353 %LD354 ");
  EXPECT_EQ(named(iec(), p2p_result_flags(iec(), 2, 0)), "%LX11264 %LX11265 %LW705 %LD353 %LD354 ");
  EXPECT_EQ(named(iec(), p2p_result_flags(iec(), 3, 0)), "%LX14336 %LX14337 %LW897 %LD449 %LD450 ");
}

std::string named(const PlcModel& model, const P2pRegisters& registers) {
  std::string names = device_name(model, registers.station);
  for (const auto* areas : {&registers.read, &registers.save})
    for (const P2pRegisters::Area& area : *areas)
      names += ' ' + device_name(model, area.name) + ' ' + device_name(model, area.size);
  return names;
}

// Cnet EN and KO Appendix 2.2
TEST(P2pRegisters, PrintedAddresses) {
  EXPECT_EQ(named(mk(), p2p_registers(mk(), 1, 0)),
            "%NW0 %NW1 %NW5 %NW6 %NW10 %NW11 %NW15 %NW16 %NW20 %NW21 %NW25 %NW26 %NW30 %NW31 %NW35 "
            "%NW36 %NW40");
  EXPECT_EQ(named(iec(), p2p_registers(iec(), 1, 0)),
            "%NW0 %NW1 %NW6 %NW7 %NW12 %NW13 %NW18 %NW19 %NW24 %NW25 %NW30 %NW31 %NW36 %NW37 %NW42 "
            "%NW43 %NW48");
  const auto first = [](const PlcModel& model, unsigned parameter, unsigned block) {
    return p2p_registers(model, parameter, block).station.index;
  };
  EXPECT_EQ(first(mk(), 1, 1), 41u);
  EXPECT_EQ(first(mk(), 1, 2), 82u);
  EXPECT_EQ(first(mk(), 2, 0), 1312u);
  EXPECT_EQ(first(mk(), 3, 0), 2624u);
  EXPECT_EQ(p2p_registers(mk(), 3, 31).save[3].size.index, 3935u);
  EXPECT_EQ(first(iec(), 1, 1), 49u);
  EXPECT_EQ(first(iec(), 1, 2), 98u);
  EXPECT_EQ(first(iec(), 2, 0), 1568u);
  EXPECT_EQ(first(iec(), 3, 0), 3136u);
  EXPECT_EQ(p2p_registers(iec(), 3, 31).save[3].size.index, 4703u);
}

TEST(P2pRegisters, EveryModelHasThem) {
  for (const PlcModel& model : plc::plc_models()) {
    EXPECT_TRUE(plc::fits(model, p2p_registers(model, 3, 31).save[3].size)) << model.name;
    EXPECT_TRUE(plc::fits(model, p2p_result_flags(model, 3, 31).errors)) << model.name;
  }
}

plc::PlcMemory written(const PlcModel& model, const char* p2p) {
  plc::PlcMemory memory(model);
  const Result<P2pParameters> parameters = parse_p2p_parameters(nlohmann::json::parse(p2p), model);
  EXPECT_TRUE(parameters) << (parameters ? "" : parameters.error().message);
  if (parameters) write_p2p_registers(memory, *parameters);
  return memory;
}

TEST(P2pRegisters, ShowARead) {
  const plc::PlcMemory memory =
      written(mk(), R"({"blocks": [{"block": 1, "flag": "F92", "read": ["%MW100", "%DW10239"],
                                             "save": ["%MW00200", "%KW1"], "station": 2}]})");
  EXPECT_EQ(*plc::get_by_name(memory, "%NW41", 0), "0002");
  EXPECT_EQ(*plc::get_by_name(memory, "%NB84", 20),
            "254D573130300000"
            "0200");  // %MW100, 2 bytes
  EXPECT_EQ(*plc::get_by_name(memory, "%NB94", 20),
            "2544573130323339"
            "0200");  // %DW10239: all of the four words
  EXPECT_EQ(*plc::get_by_name(memory, "%NB104", 20), "00000000000000000000");  // no third
  EXPECT_EQ(*plc::get_by_name(memory, "%NB124", 20),
            "254D573230300000"
            "0200");                                        // saved in %MW200
  EXPECT_EQ(*plc::get_by_name(memory, "%NW0", 4), "0000");  // block 0 is not set up
}

TEST(P2pRegisters, ShowAWrite) {
  const plc::PlcMemory memory = written(
      iec(), R"({"parameter": 2, "blocks": [{"function": "write", "flag": "_T200MS", "type": "byte",
                                              "command": "continuous", "size": 10, "read": "%MB250", "save": "%QW15.15.3", "station": 5}]})");
  EXPECT_EQ(*plc::get_by_name(memory, "%NW1568", 0), "0005");
  EXPECT_EQ(*plc::get_by_name(memory, "%NB3138", 24),
            "254D4232353000000000"
            "0A00");  // read here: %MB250, 10 bytes
  EXPECT_EQ(*plc::get_by_name(memory, "%NB3186", 24),
            "25515731352E31352E33"
            "0A00");  // saved there: ten characters
}

TEST(DeviceName, IsUnpadded) {
  const auto name = [](const PlcModel& model, std::string_view text) {
    return device_name(model, plc::parse_address(model, text).address);
  };
  EXPECT_EQ(name(mk(), "%MX0010A"), "%MX10A");
  EXPECT_EQ(name(mk(), "%MX0000A"), "%MXA");
  EXPECT_EQ(name(mk(), "%TX0012"), "%TX12");
  EXPECT_EQ(name(mk(), "%DD00050"), "%DD50");
  EXPECT_EQ(name(iec(), "%MX0170"), "%MX170");
  EXPECT_EQ(name(iec(), "%IW1.0.2"), "%IW66");
}

}  // namespace
}  // namespace fieldproof::p2p
