// fieldproof_libfuzzer: the targets of fieldproof_fuzz, for libFuzzer. FIELDPROOF_FUZZ_TARGET names
// the one that is fed; options and folders are libFuzzer's.
#include <cstdio>
#include <cstdlib>

#include "suites/fuzz/targets.hpp"

namespace {

const fieldproof::fuzz::Target* target = nullptr;

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  const char* const name = std::getenv("FIELDPROOF_FUZZ_TARGET");
  target = fieldproof::fuzz::find_target(name ? name : "");
  if (target) {
    target->seeds();  // what is read once is read here: it is no slow input
    return 0;
  }
  std::fprintf(stderr, "set FIELDPROOF_FUZZ_TARGET to one of:\n");
  for (const fieldproof::fuzz::Target& one : fieldproof::fuzz::targets())
    std::fprintf(stderr, "  %s\n", std::string(one.name).c_str());
  std::exit(2);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  target->feed({data, size});
  return 0;
}
