// One block of a P2P parameter, checked: what a P2P client does when its condition rises (Cnet EN
// and KO 6.2.4).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "src/base/time.hpp"
#include "src/plc/address.hpp"

namespace fieldproof::p2p {

constexpr unsigned p2p_parameters =
    3;  // 1: built-in channels, 2 and 3: communication modules (Cnet KO 6.2.1)
constexpr unsigned p2p_blocks = 32;            // of a parameter
constexpr std::size_t p2p_max_variables = 4;   // of a block (Cnet EN table 6.2.3)
constexpr std::size_t p2p_max_bytes = 120;     // of continuous data
constexpr unsigned highest_mail_number = 255;  // of a message, of an address

/// Error codes of a block's STATUS (Cnet EN and KO Appendix 3.3).
namespace p2p_error {
constexpr std::uint16_t none = 0, head = 0x01, tail = 0x02, bcc = 0x03, station = 0x04,
                        driver = 0x05, send = 0x07, no_module = 0x09, time_out = 0x0A,
                        length = 0x0B, not_hex = 0x0D, range = 0x0E, nak = 0x0F;
}

/// One value, or one run of values: where it is in the partner and where in this PLC.
struct P2pVariable {
  std::string partner{};  // as the driver spells it: "%MW100", "0x40001", "1230"; empty: of a user
                          // frame, or of a mail
  plc::DeviceAddress own{};  // the save area of a read or receive, the read area of a write or
                             // send, the data of an esend
};

/// When a block fires: at the rising edge of a bit, or of a clock. Neither: a RECEIVE block, which
/// is always armed.
struct P2pCondition {
  std::optional<plc::DeviceAddress> flag{};
  Duration period{};  // of a clock: 20 ms, 200 ms or 1 s
};

struct P2pBlock {
  enum class Function { read, write, send, receive, esend, ereceive };

  unsigned number = 0;   // 0-31
  unsigned channel = 1;  // 1 or 2; of an Ethernet module 1 to 3; 0: e-mail, which needs none
  Function function = Function::read;
  bool continuous =
      false;        // a run of `size` elements from one variable on, else up to four single values
  char type = 'W';  // of the data: X B W D L
  unsigned size = 1;     // elements of a run; bytes of a user frame's variable
  unsigned station = 0;  // of the partner
  std::vector<P2pVariable> variables{};
  std::string frame{};                // send and receive: "GROUP.FRAME" of the user frames
  unsigned message = 0, address = 0;  // esend: their numbers in the e-mail settings
  P2pCondition condition{};

  bool is_mail() const { return function == Function::esend || function == Function::ereceive; }
  bool is_user_frame() const { return function == Function::send || function == Function::receive; }
  /// Elements that the block carries from or to one variable.
  unsigned elements() const { return continuous ? size : 1; }
};

}  // namespace fieldproof::p2p
