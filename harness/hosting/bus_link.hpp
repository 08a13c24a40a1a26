// The fieldbus between two emulated devices in two processes (src/plc/bus_end.hpp), carried over
// one TCP connection, a line of text each. Who comes first waits for the other.
#pragma once

#include <poll.h>

#include <string>
#include <vector>

#include "harness/system/unique_fd.hpp"
#include "src/base/result.hpp"
#include "src/plc/bus_end.hpp"

namespace fieldproof::hosting {

class BusLink {
 public:
  /// [HOST:]PORT; without HOST: loopback. Errors are the user's.
  static Result<BusLink> open(const std::string& address);

  /// "bus 127.0.0.1:7000"
  const std::string& describe() const { return description_; }
  void add_to(std::vector<pollfd>& fds) const;
  /// Takes what the other has told. Errors say why the two do not fit together; they are apart
  /// then.
  Status serve(plc::BusEnd& end);
  /// Tells what the end has to tell.
  void tell(plc::BusEnd& end);
  /// A fresh device has the end from now on.
  void begin(plc::BusEnd& end);

 private:
  Status meet();
  void greet(plc::BusEnd& end);
  void send(const std::string& line);
  Status hear_lines(plc::BusEnd& end);

  std::string address_, description_;
  os::UniqueFd waiting_, joined_;  // one of the two
  bool greeted_ = false;
  std::string heard_;
};

}  // namespace fieldproof::hosting
