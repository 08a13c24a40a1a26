// Objects of a XINJE PLC through Modbus (X-NET 3-4-2): coils are read and written by function codes
// 01 and 0F, registers by 03 and 10, at the data addresses of src/xnet/areas.hpp. No base moves
// them.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/protocol.hpp"
#include "src/xnet/areas.hpp"
#include "suites/modbus/framing.hpp"

namespace fieldproof::modbus_suite {

/// xd, and the models of X-NET.
bool is_xinje_model(std::string_view model);

class XinjeObjects {
 public:
  explicit XinjeObjects(const Framing& framing, xnet::Series series = xnet::Series::xd5)
      : framing_(framing), series_(series) {}
  XinjeObjects(const Framing& framing, std::string_view model);

  xnet::Series series() const { return series_; }

  /// Errors say what Modbus does not show, or what a request does not set.
  Result<std::vector<Bytes>> write_requests(int station, std::string_view address,
                                            std::string_view hex) const;
  Result<std::vector<Bytes>> read_requests(int station, std::string_view address,
                                           std::size_t digits) const;
  /// Coils have two digits each. What is behind the last one that was asked for is cut off by who
  /// asked.
  Result<std::string> digits_in(ByteView reply) const;

  /// What the messages in a request would write, area by area; "?" where the map has none.
  std::vector<harness::Protocol::Written> written_by(ByteView request) const;
  std::vector<harness::Protocol::Place> places(const harness::Protocol::Written& written) const;
  std::optional<harness::Protocol::Written> named(std::string_view address,
                                                  std::size_t digits) const;
  /// As many as Modbus shows; 0: there is no such area.
  std::uint32_t words_of(std::string_view area) const;

 private:
  /// Consecutive components, as one request reaches them.
  struct Slice {
    xnet::Component first;
    std::size_t count = 0;
    std::uint32_t data_address() const { return first.area->modbus + first.number; }
  };
  Result<std::vector<Slice>> slices(std::string_view address, std::size_t digits) const;

  const Framing& framing_;
  xnet::Series series_;
};

/// harness::Protocol::read_word and spell.
std::optional<harness::Protocol::WordName> read_xinje_word(std::string_view text);
std::string spell_xinje(std::string_view area, std::uint32_t word);
/// Those of modules are registers.
inline std::vector<std::string_view> xinje_outputs() { return {"Y", "QD"}; }

/// "3": an object makes that axis move, or changes how it moves (SM2000, SD2000, SFD3000, HSD100
/// and what follows for 20 axes; X-NET 2-4). Empty: it is none.
std::string xinje_axis(const xnet::Component& object);

}  // namespace fieldproof::modbus_suite
