#include "harness/bench/what_to_check.hpp"

#include <fmt/format.h>

namespace fieldproof::bench {

namespace {

bool on_network(const exchange::Channel& device) {
  return exchange::implicit_transport(device).has_value();
}

}  // namespace

std::string why_silent(const exchange::Channel& device, exchange::Sign sign) {
  const std::string where = device.endpoint->describe();
  const int station = device.station;
  if (sign == exchange::Sign::refused && device.endpoint->was_refused())
    return fmt::format(
        "connection refused: nothing listens on {}; check the address, the port and "
        "that the server of the device is enabled, and that its table of hosts lets "
        "this computer in",
        where);
  if (sign == exchange::Sign::ended || sign == exchange::Sign::refused)
    return fmt::format(
        "{} takes a connection and ends it without an answer: check that its "
        "table of hosts lets this computer in and that other clients leave it a "
        "connection (a device takes few)",
        where);
  if (sign == exchange::Sign::endless)
    return fmt::format(
        "what comes from {} does not end, so that no request gets an answer: check that nobody "
        "else sends there, and that speed, data bits, parity and stop bits are those of the device",
        where);
  if (sign == exchange::Sign::echo && on_network(device))
    return fmt::format(
        "the bench hears its own requests: echo on {}: whatever listens there sends back what it "
        "receives; check that address and port are those of the device",
        where);
  if (sign == exchange::Sign::echo)
    return fmt::format(
        "the bench hears its own requests: echo on {}: what it sends comes back. Switch the "
        "adapter to two wires without echo (rs485=1, or rs485=rts), the module to RS-485, not "
        "RS-422 (Cnet EN 11.2.4), and see that TX and RX are not joined; where the adapter cannot, "
        "write echo=on behind the '?' of the endpoint: then the bench takes its own bytes out of "
        "what it receives",
        where);
  if (on_network(device))
    return fmt::format(
        "nothing answers on {}: check that the device has power, that address and "
        "port are its own, that no firewall lies between, that its table of hosts "
        "lets this computer in and that other clients leave it a connection (a "
        "device takes few)",
        where);
  return fmt::format(
      "nothing answers on {} at station {}: check that the device has power, that "
      "speed, data bits, parity and stop bits are its own, that its station number "
      "is {} and that A and B are not swapped",
      where, station, station);
}

std::string why_nothing_is_asked(const exchange::Channel& device) {
  const std::string plc = fmt::format(
      "nothing is asked on {}: check that the PLC is in RUN, that P2P has its link enable (Cnet EN "
      "11.2.2), that the block's condition flag rises",
      device.endpoint->describe());
  if (on_network(device))
    return plc +
           ", that its channel has the address and port of this computer and that no "
           "firewall lies between";
  return plc +
         ", that speed, data bits, parity and stop bits are the same on both sides and that "
         "A and B are not swapped";
}

}  // namespace fieldproof::bench
