#include "src/xnet_network/port_results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "src/xnet/words.hpp"

namespace fieldproof::xnet {

namespace {

struct Code {
  std::string_view what;
  unsigned code;
};
constexpr std::array of_modbus{Code{"correct", 0},
                               Code{"receive error", 100},
                               Code{"receive overtime", 101},
                               Code{"CRC error", 180},
                               Code{"LRC error", 181},
                               Code{"station no. error", 182},
                               Code{"send buffer overflow", 183},
                               Code{"function code error", 400},
                               Code{"address error", 401},
                               Code{"length error", 402},
                               Code{"data error", 403},
                               Code{"slave busy", 404},
                               Code{"memory error", 405}};
constexpr std::array of_sending{Code{"correct", 0}, Code{"send buffer overflow", 410}};
constexpr std::array of_receiving{Code{"correct", 0},           Code{"data length overflow", 410},
                                  Code{"data short", 411},      Code{"data long", 412},
                                  Code{"error", 413},           Code{"overtime", 414},
                                  Code{"no start symbol", 415}, Code{"no end symbol", 416}};

/// SD140 of port 0; those of the next port lie ten further on.
constexpr unsigned modbus_register = 140, send_register = 142, receive_register = 143,
                   quantity_register = 144;

constexpr std::string_view modbus = "modbus port ", free_format = "free format port ";

Error wrong(std::string_view action, const std::string& what) {
  return fail(fmt::format("cannot do '{}': {}", action, what));
}

struct Shown {
  unsigned number = 0, value = 0;
};

/// The code of what the words say, for the register of port 0.
std::optional<Shown> find_code(std::span<const Code> codes, unsigned number,
                               std::string_view what) {
  const auto found = std::ranges::find(codes, what, &Code::what);
  if (found == codes.end()) return std::nullopt;
  return Shown{number, found->code};
}

std::optional<Shown> result_of_free_format(std::string_view what) {
  Words words(what);
  const std::string_view way = words.next();
  if (way == "send") return find_code(of_sending, send_register, words.rest());
  if (way == "receive") return find_code(of_receiving, receive_register, words.rest());
  const std::optional<std::uint32_t> bytes = plain_number(words.next());
  if (way != "received" || words.rest() != "bytes" || !bytes || *bytes > 0xFFFF)
    return std::nullopt;
  return Shown{quantity_register, *bytes};
}

/// The register of the port that is named, and its value.
Result<Shown> read_port_result(std::string_view action, const Model& model) {
  const bool asks_modbus = action.starts_with(modbus);
  Words words(action.substr((asks_modbus ? modbus : free_format).size()));
  const std::string_view word = words.next();
  const std::optional<std::uint32_t> port = plain_number(word);
  if (!port || *port < model.first_port || *port > model.last_port)
    return wrong(action, fmt::format("the port '{}'; serial ports of {} are {} to {}", word,
                                     model.name, model.first_port, model.last_port));
  const std::optional<Shown> shown = asks_modbus
                                         ? find_code(of_modbus, modbus_register, words.rest())
                                         : result_of_free_format(words.rest());
  if (!shown) return wrong(action, "1-5-1 has no such result");
  return Shown{shown->number + 10 * *port, shown->value};
}

}  // namespace

bool is_port_result(std::string_view action) {
  return action.starts_with(modbus) || action.starts_with(free_format);
}

Status check_port_result(std::string_view action, const Model& model) {
  const Result<Shown> shown = read_port_result(action, model);
  return shown ? ok() : Status(shown.error());
}

Status tell_port_result(std::string_view action, const Model& model, Memory& memory) {
  const Result<Shown> shown = read_port_result(action, model);
  if (!shown) return shown.error();
  memory.touch();
  memory.write(component_in("SD", shown->number), shown->value);
  return ok();
}

}  // namespace fieldproof::xnet
