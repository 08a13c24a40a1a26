// The LS Bus client (Cnet EN and KO chapter 8).
#include "src/ls_bus/codec.hpp"
#include "suites/p2p/broken/faults.hpp"

namespace fieldproof::p2p_broken {

using p2p::P2pBlock;

namespace {

void set_sum(Bytes& frame) {
  const std::size_t sum = frame.size() - 3;
  std::ranges::copy(hex_number(ls_bus::ls_sum(ByteView(frame).subspan(1, sum - 1)), 2),
                    frame.begin() + static_cast<std::ptrdiff_t>(sum));
}

MakeBehaviour spoils_with_sum(std::function<void(Bytes& request)> edit) {
  return spoils([=](Bytes& request) {
    edit(request);
    set_sum(request);
  });
}

void accept_any_sum(Bytes& frame, const P2pBlock&) {
  if (frame.size() >= 7) set_sum(frame);
}

/// A sum that is right in one of its digits is taken: `from_end` is where it stands.
auto accept_one_digit(std::size_t from_end) {
  return [=](Bytes& frame, const P2pBlock& block) {
    Bytes right = frame;
    accept_any_sum(right, block);
    if (right.size() == frame.size() && frame.size() > from_end &&
        frame[frame.size() - from_end] == right[frame.size() - from_end])
      frame = right;
  };
}

std::optional<std::uint16_t> nak_is_normal(const p2p::P2pDriver& good, const P2pBlock& block,
                                           const Bytes& frame, plc::PlcMemory& memory) {
  const auto error = good.take(block, frame, memory);
  return error == p2p::p2p_error::nak ? p2p::p2p_error::none : error;
}

std::optional<std::uint16_t> ls_echo_not_compared(const p2p::P2pDriver& good, const P2pBlock& block,
                                                  const Bytes& frame, plc::PlcMemory& memory) {
  const auto error = good.take(block, frame, memory);
  return error == p2p::p2p_error::driver && ls_bus::parse_ls_reply(frame).command == 'W'
             ? p2p::p2p_error::none
             : error;
}

void set_station(Bytes& frame, const P2pBlock& block) {
  if (!ls_bus::parse_ls_reply(frame).station) return;
  std::ranges::copy(hex_number(block.station, 2), frame.begin() + 1);
  set_sum(frame);
}

}  // namespace

std::vector<Fault> ls_bus_faults() {
  constexpr std::size_t count_of_read = 8;
  return {
      {"sum_missing", "the request has no sum",
       spoils([](Bytes& request) { request.erase(request.end() - 3, request.end() - 1); }),
       "ls_bus/client/example/read", "address: expected 1230, got 123"},
      {"sum_with_header", "ENQ is in the sum", spoils([](Bytes& request) {
         const std::size_t sum = request.size() - 3;
         std::ranges::copy(hex_number(ls_bus::ls_sum(ByteView(request).first(sum)), 2),
                           request.begin() + static_cast<std::ptrdiff_t>(sum));
       }),
       "ls_bus/client/example/read", "SUM: expected AA, got AF"},
      {"ls_count_plus_one", "a read asks for one word more", spoils_with_sum([](Bytes& request) {
         if (request.at(3) == 'R') ++request.at(count_of_read);
       }),
       "ls_bus/client/example/read", "count: expected 1, got 2"},
      {"ls_write_order_swapped", "a write has count and address in each other's place",
       spoils_with_sum([](Bytes& request) {
         if (request.at(3) == 'W')
           std::rotate(request.begin() + 4, request.begin() + 8, request.begin() + 9);
       }),
       "ls_bus/client/example/write_address_first", "count: expected 1, got 1"},
      {"ls_address_plus_one", "the address that goes out is one too high",
       asks_for([](P2pBlock& block) {
         std::string& address = block.variables[0].partner;
         address = hex_number(*ls_bus::parse_ls_address(address) + 1, 4);
       }),
       "ls_bus/client/example/read", "address: expected 1230, got 1231"},
      {"ls_station_of_own", "the request goes to station 00",
       asks_for([](P2pBlock& block) { block.station = 0; }), "ls_bus/client/example/read",
       "station: expected 01, got 00"},
      {"ls_nak_is_normal", "NAK is a normal end", takes(nak_is_normal),
       "ls_bus/client/error/nak/c00", "%LW512 holds 0001"},
      {"ls_echo_not_compared", "an ACK that repeats other data than written is a normal end",
       takes(ls_echo_not_compared), "ls_bus/client/error/other_echo/other", "%LW512 holds 0001"},
      {"ls_foreign_station", "the reply of another station is accepted", hears(set_station),
       "ls_bus/client/error/wrong_station/s0", "%MW119 holds 13575ABC9BDF86427531FDB9"},
      {"ls_sum_first_digit_alone", "of the sum the first digit alone is compared",
       hears(accept_one_digit(3)), "ls_bus/client/error/wrong_sum/second_digit",
       "%MW119 holds 13575ABC9BDF86427531FDB9"},
      {"ls_sum_second_digit_alone", "of the sum the second digit alone is compared",
       hears(accept_one_digit(2)), "ls_bus/client/error/wrong_sum/first_digit",
       "%MW119 holds 13575ABC9BDF86427531FDB9"},
      {"ls_sum_ignored", "a wrong sum is accepted", hears(accept_any_sum),
       "ls_bus/client/error/wrong_sum/wrong", "%MW119 holds 13575ABC9BDF86427531FDB9"},
  };
}

}  // namespace fieldproof::p2p_broken
