#include "src/plc/memory.hpp"

#include <gmock/gmock.h>

#include <stdexcept>

namespace fieldproof::plc {
namespace {

using ::testing::HasSubstr;

PlcMemory memory_of(std::string_view model) { return PlcMemory(*find_plc_model(model)); }

std::string get(const PlcMemory& memory, std::string_view address, std::size_t digits = 0) {
  const Result<std::string> value = get_by_name(memory, address, digits);
  return value ? *value : value.error().message;
}

void set(PlcMemory& memory, std::string_view address, std::string_view hex) {
  const Status status = set_by_name(memory, address, hex);
  ASSERT_TRUE(status) << status.error().message;
}

TEST(PlcMemory, WordsReadAsEveryOtherType) {
  PlcMemory memory = memory_of("xbc-h");
  set(memory, "%MW100", "123456789ABCDEF0");  // M100 = 1234, M101 = 5678, M102 = 9ABC, M103 = DEF0
  EXPECT_EQ(get(memory, "%MW101"), "5678");
  EXPECT_EQ(get(memory, "%MB200"), "34");
  EXPECT_EQ(get(memory, "%MB201"), "12");
  EXPECT_EQ(get(memory, "%MD50"), "56781234");
  EXPECT_EQ(get(memory, "%ML25"), "DEF09ABC56781234");
  EXPECT_EQ(get(memory, "%MX1002"), "01");  // 1234 = 0001 0010 0011 0100
  EXPECT_EQ(get(memory, "%MX1003"), "00");
  EXPECT_EQ(get(memory, "%MX100C"), "01");
  EXPECT_EQ(get(memory, "%MX100D"), "00");
}

TEST(PlcMemory, EveryTypeWritesWhatWordsRead) {
  PlcMemory memory = memory_of("xbc-h");
  set(memory, "%DL25", "0123456789ABCDEF");
  EXPECT_EQ(get(memory, "%DW100", 16), "CDEF89AB45670123");
  set(memory, "%DD51", "CAFEBABE");
  EXPECT_EQ(get(memory, "%DW102", 8), "BABECAFE");
  set(memory, "%DB201", "5A");
  EXPECT_EQ(get(memory, "%DW100"), "5AEF");
  set(memory, "%DB200", "A5");
  EXPECT_EQ(get(memory, "%DW100"), "5AA5");
  set(memory, "%MX0010A", "01");
  EXPECT_EQ(get(memory, "%MW10"), "0400");
  set(memory, "%MW10", "FFFF");
  set(memory, "%MX0010A", "00");
  EXPECT_EQ(get(memory, "%MW10"), "FBFF");
  EXPECT_EQ(get(memory, "%MW9"), "0000");
  EXPECT_EQ(get(memory, "%MW11"), "0000");
}

TEST(PlcMemory, ContactsAreApartFromValues) {
  PlcMemory memory = memory_of("xbc-h");
  set(memory, "%TX0005", "01");
  EXPECT_EQ(get(memory, "%TW0"), "0000");
  set(memory, "%TW5", "FFFF");
  EXPECT_EQ(get(memory, "%TX5"), "01");
  EXPECT_EQ(get(memory, "%TX0"), "00");
  EXPECT_EQ(get(memory, "%TX80"), "00");
  EXPECT_EQ(get(memory, "%CX5"), "00");
}

TEST(PlcMemory, DottedAndFlatNamesAreTheSameMemory) {
  PlcMemory memory = memory_of("xec-h");
  set(memory, "%IW0.1.0", "A55A");
  EXPECT_EQ(get(memory, "%IW4"), "A55A");
  EXPECT_EQ(get(memory, "%IX0.1.1"), "01");
  EXPECT_EQ(get(memory, "%IX65"), "01");
  EXPECT_EQ(get(memory, "%QW4"), "0000");
}

TEST(PlcMemory, AreasDoNotOverlap) {
  for (const PlcModel& model : plc_models()) {
    PlcMemory memory(model);
    std::uint64_t n = 1;
    const auto end_words = [&](auto&& use) {
      for (std::uint8_t i = 0; i < model.areas.size(); ++i) {
        if (model.areas[i].same_as != 0) continue;
        use(DeviceAddress{i, 'W', false, 0});
        use(DeviceAddress{i, 'W', false, model.areas[i].last_word()});
      }
    };
    end_words([&](const DeviceAddress& a) { memory.write(a, n++); });
    n = 1;
    end_words([&](const DeviceAddress& a) {
      EXPECT_EQ(memory.read(a), n++) << model.name << ' ' << model.areas[a.area].letter;
    });
  }
}

/// FEnet A.1.2.
TEST(PlcMemory, WOfTheXecHasTheWordsOfR) {
  PlcMemory memory = memory_of("xec-h");
  set(memory, "%WW10239", "A55A");
  EXPECT_EQ(get(memory, "%RW10239"), "A55A");
  set(memory, "%RX16", "01");
  EXPECT_EQ(get(memory, "%WW1"), "0001");
  EXPECT_EQ(get(memory, "%MW1"), "0000");
}

TEST(PlcMemory, OutsideIsAProgrammersError) {
  PlcMemory memory = memory_of("xbm-s");
  EXPECT_THROW(memory.read({0, 'W', false, 128}), std::out_of_range);
  EXPECT_THROW(memory.write({0, 'L', false, 32}, 0), std::out_of_range);
  EXPECT_THROW(memory.read({99, 'W', false, 0}), std::out_of_range);
}

TEST(BackDoor, IsNotBoundByRights) {
  PlcMemory memory = memory_of("xbc-h");
  set(memory, "%FW10", "1234");
  set(memory, "%NW5119", "5678");
  EXPECT_EQ(get(memory, "%FW10"), "1234");
  EXPECT_EQ(get(memory, "%NW5119"), "5678");
}

TEST(BackDoor, ErrorsNameTheAddress) {
  PlcMemory memory = memory_of("xbc-h");
  const auto error = [&](std::string_view address, std::string_view hex) {
    const Status status = set_by_name(memory, address, hex);
    return status ? std::string("ok") : status.error().message;
  };
  EXPECT_EQ(error("%ZW0", "0000"), "cannot set %ZW0 on xbc-h: the model has no such area");
  EXPECT_EQ(error("%MW1024", "0000"), "cannot set %MW1024 on xbc-h: it is beyond the area");
  EXPECT_THAT(error("%MW0", "123"), HasSubstr("give 4 digits for each"));
  EXPECT_THAT(error("%MW0", ""), HasSubstr("there is no value"));
  EXPECT_THAT(error("%MW0", "12G4"), HasSubstr("'G' is not a hex digit"));
  EXPECT_THAT(error("%MX0", "02"), HasSubstr("a bit is 00 or 01"));
  EXPECT_THAT(error("%MW1023", "12345678"), HasSubstr("cannot set 2 elements from %MW1023 on"));
  EXPECT_EQ(get(memory, "%MW1023"), "0000");
  EXPECT_THAT(get(memory, "%MW1023", 8), HasSubstr("the area ends before"));
  EXPECT_THAT(get(memory, "MW0"), HasSubstr("it does not begin with %"));
}

TEST(BackDoor, RefusedValueWritesNothing) {
  PlcMemory memory = memory_of("xbc-h");
  EXPECT_FALSE(set_by_name(memory, "%MW0", "1234XXXX"));
  EXPECT_EQ(get(memory, "%MW0"), "0000");
}

}  // namespace
}  // namespace fieldproof::plc
