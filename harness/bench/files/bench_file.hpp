// The bench file: which devices hang on this bench, how each is reached, and what it is. One JSON
// file, kept by hand:
//   {"devices": {"c41a": {
//     "endpoint": "serial:/dev/serial/by-id/usb-FTDI...?rs485=1", "profile": "xbc-dxxxh",
//     "station": 3, "line": "38400-8N1", "identity": {"maker": "LS ELECTRIC", "model": "XBL-C41A",
//     "serial": "2219-00417", "firmware": "V1.41"}, "fingerprint": {"areas": "CDFKLMNPTU", "M":
//     "0-255"}, "allow_write": ["M100-M199", "D0"], "operator": "J. Kim", "notes": "port 2,
//     terminated both ends"}}}
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/safety/fence.hpp"
#include "reports/results/case_result.hpp"
#include "src/base/result.hpp"

namespace fieldproof::bench {

struct BenchDevice {
  std::string endpoint;  // as written; endpoint_of() adds station and line
  std::string profile;   // a name, or a path (relative ones start at the bench file's folder);
                         // empty: none named
  std::optional<int> station;            // 0 to 255
  std::string line;                      // "38400-8N1"; empty: what the endpoint says
  std::string stimulus, control, aux;    // as --stimulus, --control and --aux take them
  std::vector<std::string> allow_write;  // as --allow-write takes them
  results::Identity identity;            // with the device's name, operator and notes
};

struct BenchFile {
  std::string path;
  std::map<std::string, BenchDevice> devices;
};

/// Errors name the file, the line or the key ("devices.c41a.station"), what is wrong and the
/// nearest right word.
Result<BenchFile> load_bench_file(const std::string& path, const safety::WordReader& words);
/// The text of a bench file; `path` is for messages, and for the folder of relative profiles.
Result<BenchFile> parse_bench_file(const std::string& text, const std::string& path,
                                   const safety::WordReader& words);

/// The device of that name; the error says which there are.
Result<BenchDevice> find_device(const BenchFile& file, const std::string& name);

/// The devices whose identity is so: "model=XBL-C41A" (or maker, serial, firmware). Those that are
/// named by a whole name with '=' are themselves. The error says what there is.
Result<std::vector<std::string>> find_devices(const BenchFile& file, const std::string& wanted);

/// The endpoint with station and line as its options:
/// "serial:/dev/ttyUSB0?station=3&baud=38400&frame=8N1". A kind that sets no line (tcp, exec) takes
/// the station alone.
std::string endpoint_of(const BenchDevice& device);

}  // namespace fieldproof::bench
