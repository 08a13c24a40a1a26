// The way that a program made of libmodbus speaks over, by its arguments: `TTY`, RTU at 9600-8N1,
// or `tcp PORT`, of this computer.
#pragma once

#include <modbus/modbus.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string_view>

struct FreeModbus {
  void operator()(modbus_t* context) const { modbus_free(context); }
  void operator()(modbus_mapping_t* mapping) const { modbus_mapping_free(mapping); }
};
using Modbus = std::unique_ptr<modbus_t, FreeModbus>;

inline bool is_tcp(int count, char** arguments) {
  return count == 3 && std::string_view(arguments[1]) == "tcp";
}

/// Not yet connected. Nothing, and a word about the usage: these are no such arguments.
inline Modbus make_modbus(const char* program, int count, char** arguments) {
  if (is_tcp(count, arguments)) return Modbus(modbus_new_tcp("127.0.0.1", std::atoi(arguments[2])));
  if (count == 2) return Modbus(modbus_new_rtu(arguments[1], 9600, 'N', 8, 1));
  std::fprintf(stderr, "usage: %s TTY | tcp PORT\n", program);
  return nullptr;
}
