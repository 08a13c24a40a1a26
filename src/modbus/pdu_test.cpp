#include "src/modbus/pdu.hpp"

#include <gtest/gtest.h>

#include <random>

#include "src/modbus/test_frames.hpp"

namespace fieldproof::modbus {
namespace {

using test::hex;
using test::operator+;

struct Server {
  explicit Server(std::string_view model = "xbc-h")
      : Server(model, default_modbus_bases(*plc::find_plc_model(model))) {}
  Server(std::string_view model, const ModbusBases& bases)
      : memory(*plc::find_plc_model(model)), tables(*place_modbus_tables(memory.model(), bases)) {}

  Bytes ask(const Bytes& pdu) { return execute_modbus_request(parse_modbus_request(pdu), data); }
  std::string ask(std::string_view pdu) { return to_hex(ask(hex(pdu))); }
  void set(std::string_view address, std::string_view value) {
    ASSERT_TRUE(plc::set_by_name(memory, address, value)) << address;
  }
  std::string get(std::string_view address, std::size_t digits = 0) {
    return *plc::get_by_name(memory, address, digits);
  }
  std::string dump() {
    std::string all;
    for (const plc::DeviceArea& area : memory.model().areas)
      all += get(std::string("%") + area.letter + "W0", 4 * area.words);
    return all;
  }

  plc::PlcMemory memory;
  ModbusTables tables;
  PlcDataSpace data{tables, memory};
};

Bytes request(unsigned code, unsigned address, unsigned count_or_value) {
  return hex(hex_number(code, 2) + hex_number(address, 4) + hex_number(count_or_value, 4));
}

/// FC 0F and 10 with data of the right size.
Bytes write_request(unsigned code, unsigned address, unsigned count, Byte data = 0xA5) {
  const std::size_t size = code == 0x0F ? (count + 7) / 8 : 2 * count;
  return request(code, address, count) + Bytes{static_cast<Byte>(size)} + Bytes(size, data);
}

/// A right request of that function for `count` elements.
Bytes any_request(unsigned code, unsigned address, unsigned count) {
  if (code == 0x0F || code == 0x10) return write_request(code, address, count);
  return request(code, address, code == 0x05 ? 0xFF00 : count);
}

// --- Examples of chapter 9.4 ---

TEST(ModbusPdu, ReadCoilStatus) {
  Server server;
  server.set("%MW1", "88900029");  // 12 31 05 from bit 19 on
  EXPECT_EQ(server.ask("01 00 13 00 13"), "01 03 12 31 05");
}

TEST(ModbusPdu, ReadInputStatus) {
  Server server;
  server.set("%PW1", "88900029");
  EXPECT_EQ(server.ask("02 00 13 00 13"), "02 03 12 31 05");
}

TEST(ModbusPdu, ReadHoldingRegisters) {
  Server server;
  server.set("%MW107", "13123D12404F");
  EXPECT_EQ(server.ask("03 00 6B 00 03"), "03 06 13 12 3D 12 40 4F");
}

TEST(ModbusPdu, ReadInputRegisters) {
  Server server;
  server.set("%PW8", "000A");
  EXPECT_EQ(server.ask("04 00 08 00 01"), "04 02 00 0A");
}

TEST(ModbusPdu, ForceSingleCoil) {
  Server server;
  EXPECT_EQ(server.ask("05 00 08 FF 00"), "05 00 08 FF 00");
  EXPECT_EQ(server.get("%MW0"), "0100");
  EXPECT_EQ(server.ask("05 00 08 00 00"), "05 00 08 00 00");
  EXPECT_EQ(server.get("%MW0"), "0000");
}

TEST(ModbusPdu, PresetSingleRegister) {
  Server server;
  EXPECT_EQ(server.ask("06 00 08 00 03"), "06 00 08 00 03");
  EXPECT_EQ(server.get("%MW7", 12), "000000030000");
}

TEST(ModbusPdu, ForceMultipleCoils) {
  Server server;
  EXPECT_EQ(server.ask("0F 00 13 00 0A 02 CD 01"), "0F 00 13 00 0A");
  EXPECT_EQ(server.get("%MW0", 12), "00000E680000");
}

TEST(ModbusPdu, PresetMultipleRegisters) {
  Server server;
  EXPECT_EQ(server.ask("10 00 13 00 02 04 CD 01 00 0A"), "10 00 13 00 02");
  EXPECT_EQ(server.get("%MW18", 16), "0000CD01000A0000");
}

// --- Tables 6.1.1 and 9.3.3 ---

TEST(ModbusPdu, FunctionCodesAndTheirBases) {
  struct Row {
    unsigned code;
    ModbusBase base;
    unsigned limit;
  };
  const Row rows[] = {{0x01, ModbusBase::bit_write, 2000}, {0x02, ModbusBase::bit_read, 2000},
                      {0x03, ModbusBase::word_write, 125}, {0x04, ModbusBase::word_read, 125},
                      {0x05, ModbusBase::bit_write, 1},    {0x06, ModbusBase::word_write, 1},
                      {0x0F, ModbusBase::bit_write, 1968}, {0x10, ModbusBase::word_write, 120}};
  ASSERT_EQ(modbus_functions().size(), std::size(rows));
  for (const Row& row : rows) {
    const ModbusFunction* function = find_modbus_function(static_cast<Byte>(row.code));
    ASSERT_TRUE(function) << row.code;
    EXPECT_EQ(function->base, row.base) << row.code;
    EXPECT_EQ(function->limit, row.limit) << row.code;
  }
}

TEST(ModbusPdu, EachBaseIsItsOwn) {
  Server server("xbc-h", {"P0010", "M0020", "K3", "L4"});
  server.set("%PX0010", "01");
  server.set("%MX0020", "01");
  server.set("%KW3", "3333");
  server.set("%LW4", "4444");
  EXPECT_EQ(server.ask("02 00 00 00 02"), "02 01 01");
  EXPECT_EQ(server.ask("01 00 00 00 02"), "01 01 01");
  EXPECT_EQ(server.ask("04 00 00 00 01"), "04 02 33 33");
  EXPECT_EQ(server.ask("03 00 00 00 01"), "03 02 44 44");
  server.ask("05 00 01 FF 00");
  EXPECT_EQ(server.get("%MW2"), "0003");
  server.ask("06 00 01 12 34");
  EXPECT_EQ(server.get("%LW4", 8), "44441234");
}

TEST(ModbusPdu, LimitsAndOnePast) {
  for (const ModbusFunction& function : modbus_functions()) {
    if (function.limit == 1) continue;
    Server server;
    const Bytes reply = server.ask(any_request(function.code, 0, function.limit));
    EXPECT_EQ(reply[0], function.code);
    if (function.code < 5) {
      EXPECT_EQ(reply[1], 250);  // 2000 bits and 125 words alike
      EXPECT_EQ(reply.size(), 252u);
    }
    for (const unsigned count : {function.limit + 1, 0u, 0xFFFFu}) {
      const Bytes wrong = function.code < 5 || count > 2000
                              ? request(function.code, 0, count)
                              : write_request(function.code, 0, count);
      EXPECT_EQ(server.ask(wrong), modbus_exception_reply(function.code, modbus_exception::value))
          << count;
    }
  }
}

TEST(ModbusPdu, UnknownFunctions) {
  Server server;
  for (unsigned code = 0; code < 256; ++code) {
    if (find_modbus_function(static_cast<Byte>(code))) continue;
    const Bytes expected{static_cast<Byte>(code | 0x80), 0x01};
    EXPECT_EQ(server.ask(Bytes{static_cast<Byte>(code)}), expected) << code;
    EXPECT_EQ(server.ask(request(code, 0, 1)), expected) << code;
  }
}

TEST(ModbusPdu, WrongLengthIsAWrongValue) {
  for (const ModbusFunction& function : modbus_functions()) {
    Server server;
    const std::string before = server.dump();
    const Bytes right = any_request(function.code, 0, 1),
                wrong = modbus_exception_reply(function.code, modbus_exception::value);
    for (std::size_t size = 1; size < right.size(); ++size)
      EXPECT_EQ(server.ask(test::part(right, 0, size)), wrong) << size;
    EXPECT_EQ(server.ask(right + Bytes{0}), wrong);
    EXPECT_EQ(server.dump(), before);
    EXPECT_EQ(server.ask(right)[0], function.code);
  }
}

TEST(ModbusPdu, ByteCountMustMatch) {
  Server server;
  for (const char* pdu : {"0F 00 00 00 0A 01 CD 01", "0F 00 00 00 0A 03 CD 01",
                          "0F 00 00 00 0A 02 CD", "0F 00 00 00 0A 02 CD 01 00",
                          "0F 00 00 00 0A 01 CD", "0F 00 00 00 08 02 CD 01", "0F 00 00 00 0A 00"}) {
    EXPECT_EQ(server.ask(pdu), "8F 03") << pdu;
  }
  for (const char* pdu : {"10 00 00 00 02 02 CD 01 00 0A", "10 00 00 00 02 05 CD 01 00 0A",
                          "10 00 00 00 02 04 CD 01 00", "10 00 00 00 01 01 CD",
                          "10 00 00 00 02 02 CD 01", "10 00 00 00 01 04 CD 01 00 0A"}) {
    EXPECT_EQ(server.ask(pdu), "90 03") << pdu;
  }
}

TEST(ModbusPdu, CoilValueIsFf00Or0000) {
  Server server;
  for (const char* pdu :
       {"05 00 08 00 01", "05 00 08 01 00", "05 00 08 FF FF", "05 00 08 FE 00", "05 00 08 00 FF"}) {
    EXPECT_EQ(server.ask(pdu), "85 03") << pdu;
  }
  EXPECT_EQ(server.get("%MW0"), "0000");
}

TEST(ModbusPdu, ValueIsCheckedBeforeTheAddress) {
  Server server;
  EXPECT_EQ(server.ask("01 FF FF 07 D1"), "81 03");
  EXPECT_EQ(server.ask("01 FF FF 07 D0"), "81 02");
  EXPECT_EQ(server.ask("03 FF FF 00 00"), "83 03");
  EXPECT_EQ(server.ask("05 FF FF 12 34"), "85 03");
  EXPECT_EQ(server.ask("05 FF FF FF 00"), "85 02");
  EXPECT_EQ(server.ask("06 FF FF 00"), "86 03");
  EXPECT_EQ(server.ask("10 FF FF 00 01 03 00 00"), "90 03");
  EXPECT_EQ(server.ask("10 FF FF 00 01 02 00 00"), "90 02");
}

// --- Both ends of each area of each model ---

TEST(ModbusPdu, EndsOfEachArea) {
  for (const plc::PlcModel& model : plc::plc_models()) {
    for (const plc::DeviceArea& area : model.areas) {
      const std::string base = std::string(1, area.letter) + "0";
      const bool has_bits = area.letter != 'D';
      const std::string bits = has_bits ? base : "M0";
      Server server(model.name, {bits, bits, base, base});
      for (const ModbusFunction& function : modbus_functions()) {
        const bool is_bit =
            function.base == ModbusBase::bit_read || function.base == ModbusBase::bit_write;
        if (is_bit && !has_bits) continue;
        const unsigned elements = !is_bit              ? area.words
                                  : area.contacts != 0 ? area.contacts
                                                       : area.words * 16;
        const unsigned size = std::min(elements, 9999u);
        const bool writes = function.code > 4, refused = writes && !area.write;
        const auto exception = [&](unsigned address, unsigned count) {
          const Bytes reply = server.ask(any_request(function.code, address, count));
          return reply[0] == function.code ? 0 : reply[1];
        };
        const std::string what = std::string(model.name) + ' ' + area.letter + " function " +
                                 hex_number(function.code, 2);
        EXPECT_EQ(exception(0, 1), refused ? 2 : 0) << what;
        EXPECT_EQ(exception(size - 1, 1), refused ? 2 : 0) << what;
        EXPECT_EQ(exception(size, 1), 2) << what;
        EXPECT_EQ(exception(0xFFFF, 1), 2) << what;
        if (function.limit == 1) continue;
        EXPECT_EQ(exception(size - 2, 2), refused ? 2 : 0) << what;
        EXPECT_EQ(exception(size - 1, 2), 2) << what;  // straddles the end
      }
    }
  }
}

TEST(ModbusPdu, EndsAreTheRightElements) {
  Server server("xbm-s");
  server.set("%PX127F", "01");
  server.set("%PW127", "8001");
  EXPECT_EQ(server.ask("02 07 FF 00 01"), "02 01 01");  // bit 2047
  EXPECT_EQ(server.ask("04 00 7F 00 01"), "04 02 80 01");
  EXPECT_EQ(server.ask("05 0F FF FF 00"), "05 0F FF FF 00");
  EXPECT_EQ(server.get("%MW255"), "8000");
  Server large("xbc-h", {"P0", "M0", "P0", "D0"});
  EXPECT_EQ(large.ask("06 27 0E 12 34"), "06 27 0E 12 34");  // 9998
  EXPECT_EQ(large.get("%DW9998"), "1234");
  EXPECT_EQ(large.ask("06 27 0F 12 34"), "86 02");
  EXPECT_EQ(large.ask("05 27 0E FF 00"), "05 27 0E FF 00");
  EXPECT_EQ(large.get("%MX624E"), "01");  // 9998 = 624 * 16 + 14
}

TEST(ModbusPdu, RefusedWriteChangesNothing) {
  Server server("xbc-h", {"P0", "M1000F", "P0", "M1000"});
  const std::string before = server.dump();
  EXPECT_EQ(server.ask(write_request(0x10, 23, 2, 0xFF)), hex("90 02"));  // M1023 and one past
  EXPECT_EQ(server.ask(write_request(0x0F, 368, 2, 0xFF)),
            hex("8F 02"));  // M1023 bit F and one past
  EXPECT_EQ(server.dump(), before);
  EXPECT_EQ(server.ask(write_request(0x0F, 368, 1, 0xFF)), hex("0F 01 70 00 01"));
  EXPECT_EQ(server.get("%MW1022", 8), "00008000");
}

TEST(ModbusPdu, ReadOnlyAreasAreNotWritten) {
  Server server("xbc-h", {"F0", "F0", "F0", "F0"});
  server.set("%FW0", "0001");
  EXPECT_EQ(server.ask("03 00 00 00 01"), "03 02 00 01");
  EXPECT_EQ(server.ask("01 00 00 00 01"), "01 01 01");
  EXPECT_EQ(server.ask("05 00 00 00 00"), "85 02");
  EXPECT_EQ(server.ask("06 00 00 00 00"), "86 02");
  EXPECT_EQ(server.ask("0F 00 00 00 01 01 00"), "8F 02");
  EXPECT_EQ(server.ask("10 00 00 00 01 02 00 00"), "90 02");
  EXPECT_EQ(server.get("%FW0"), "0001");
}

// --- Bits in bytes, words in bits ---

TEST(ModbusPdu, LastByteIsPartlyFilled) {
  Server server;
  server.set("%MW0", "FFFFFFFF");
  EXPECT_EQ(server.ask("01 00 00 00 0B"), "01 02 FF 07");
  EXPECT_EQ(server.ask("01 00 05 00 09"), "01 02 FF 01");
}

TEST(ModbusPdu, PaddingOfForceMultipleCoilsIsNotWritten) {
  Server server;
  EXPECT_EQ(server.ask("0F 00 00 00 03 01 FF"), "0F 00 00 00 03");
  EXPECT_EQ(server.get("%MW0"), "0007");
  server.set("%MW0", "FFFF");
  EXPECT_EQ(server.ask("0F 00 04 00 0A 02 00 00"), "0F 00 04 00 0A");
  EXPECT_EQ(server.get("%MW0"), "C00F");
}

TEST(ModbusPdu, WrittenAsWordsReadAsBitsAndBack) {
  Server server;
  server.ask("10 00 01 00 02 04 12 34 56 78");
  EXPECT_EQ(server.ask("01 00 10 00 20"), "01 04 34 12 78 56");
  server.ask("0F 00 10 00 20 04 01 02 03 04");
  EXPECT_EQ(server.ask("03 00 01 00 02"), "03 04 02 01 04 03");
}

TEST(ModbusPdu, ContactsAreApartFromCurrentValues) {
  Server server("xbc-h", {"T0", "T0", "T0", "T0"});
  EXPECT_EQ(server.ask("05 00 05 FF 00"), "05 00 05 FF 00");
  EXPECT_EQ(server.get("%TX5"), "01");
  EXPECT_EQ(server.get("%TW0"), "0000");
}

TEST(ModbusPduFuzz, AnyBytesAreAnsweredWithinAFrame) {
  std::mt19937 random(1979);
  Server server;
  for (int round = 0; round < 20000; ++round) {
    Bytes pdu(1 + random() % 12);
    for (Byte& b : pdu) b = static_cast<Byte>(random() % 4 == 0 ? random() : random() % 3);
    pdu[0] = static_cast<Byte>(random() % 20);
    const Bytes reply = server.ask(pdu);
    ASSERT_GE(reply.size(), 2u) << to_hex(pdu);
    ASSERT_LE(reply.size(), modbus_max_pdu) << to_hex(pdu);
    ASSERT_EQ(reply[0] & 0x7F, pdu[0]) << to_hex(pdu);
  }
}

}  // namespace
}  // namespace fieldproof::modbus
