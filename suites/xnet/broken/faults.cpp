#include "suites/xnet/broken/broken_xnet.hpp"

namespace fieldproof::xnet_broken {

const std::vector<Fault>& faults() {
  static const std::vector<Fault> all =
      broken::gather<Fault>({data_faults, motion_faults, default_faults, axis_faults, bus_faults});
  return all;
}

}  // namespace fieldproof::xnet_broken
