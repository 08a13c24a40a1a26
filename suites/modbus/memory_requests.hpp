// Device memory through Modbus, as the bases of a device place it in the four tables: what lies in
// the two writable ones is written and read (function codes 01, 03, 0F, 10), what lies in the
// others is read (02, 04). The rest has no data address.
#pragma once

#include <string_view>
#include <vector>

#include "harness/protocol.hpp"
#include "src/modbus/bases.hpp"
#include "suites/modbus/framing.hpp"
#include "suites/modbus/functions.hpp"

namespace fieldproof::modbus_suite {

/// Which memory of which model the data addresses are.
struct Bases {
  const plc::PlcModel* model = nullptr;
  modbus::ModbusTables tables;
  bool separate = false;  // coils and registers are no memory in common
};
/// The table that a function code names.
modbus::ModbusBase base_of(const FunctionCode& function);
/// How many data addresses a message asks for.
std::uint32_t count_in(ByteView message, const FunctionCode& function);
/// Of xbc-h: P0, M0, P0, M0.
const Bases& default_bases();
/// The same as keys of given.config; of a model without bases: none.
nlohmann::json default_base_config(std::string_view model);
/// `config`: bit_read_base and its like, tables (vectors/README.md). Errors name the model or the
/// key.
Result<Bases> declared_bases(std::string_view model, const nlohmann::json& config);
/// harness::Protocol::same_setting.
bool same_setting(std::string_view model, const std::string& key, const std::string& one,
                  const std::string& other);

/// Few enough words a request for a frame of 255 characters (DECISIONS.md modbus/ascii-length), and
/// any server. Errors say why there is no way.
Result<std::vector<Bytes>> write_requests(const Framing& framing, const Bases& bases, int station,
                                          std::string_view address, std::string_view hex);
Result<std::vector<Bytes>> read_requests(const Framing& framing, const Bases& bases, int station,
                                         std::string_view address, std::size_t digits);

/// Anything but an exception: its form is for the cases to judge.
Status write_reply(const Framing& framing, ByteView reply);
Result<std::string> read_reply(const Framing& framing, ByteView reply);
/// harness::MemoryRequests::answers.
bool answers(const Framing& framing, ByteView request, ByteView reply);

/// A message that would write: `asked` data addresses from `address` on, or `count`, as many as a
/// device may believe. Without a function nobody can tell where.
struct WriteMessage {
  const FunctionCode* function = nullptr;
  std::uint32_t address = 0, asked = 0, count = 0;
};
std::vector<WriteMessage> writes_in(const Framing& framing, ByteView request);
/// What the messages in a request would write.
std::vector<harness::Protocol::Written> written_by(const Framing& framing, const Bases& bases,
                                                   ByteView request);

/// Words as names that the writable tables reach: words, else bytes through the table of bits; each
/// contact by itself.
std::vector<harness::Protocol::Place> places(const Bases& bases,
                                             const harness::Protocol::Written& written);

/// The data address of a frame, or none: where the message is damaged, or a reply without one.
std::vector<harness::Protocol::AddressField> address_fields(const Framing& framing,
                                                            const Bases& bases, ByteView frame,
                                                            bool reply);
/// Nothing as well where the request reaches the end of its table.
std::optional<Bytes> moved_field(const Framing& framing, const Bases& bases, ByteView frame,
                                 const harness::Protocol::AddressField& field, int words);

}  // namespace fieldproof::modbus_suite
