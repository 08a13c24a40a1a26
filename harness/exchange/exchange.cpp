#include "harness/exchange/exchange.hpp"

#include "harness/exchange/case_run.hpp"

namespace fieldproof::exchange {

Transcript Exchange::run(const PreparedCase& prepared) {
  CaseRun run({device_, timing_, aux_, arming_}, prepared);
  run.execute();
  run.finish();
  return run.take();
}

Transcript Exchange::run_steps(const PreparedCase& prepared) {
  CaseRun run({device_, timing_, aux_, arming_}, prepared);
  run.execute();
  return run.take();
}

Result<Sign> Exchange::anything_answers(int station, Duration patience, Duration reply_delay,
                                        bool starting) {
  return Sanity(at(station), timing_).anything_answers(patience, reply_delay, starting);
}

Result<Sign> Exchange::first_sign(int station, Duration patience) {
  return Sanity(at(station), timing_).first_sign(patience);
}

Result<bool> Exchange::anything_is_asked(const PreparedCase& prepared, Duration patience) {
  return CaseRun({device_, timing_, aux_, arming_}, prepared).is_asked(patience);
}

Result<results::ResponseTimes> Exchange::time_probes(int station, int count, Duration budget) {
  return Sanity(at(station), timing_).time_probes(count, budget);
}

}  // namespace fieldproof::exchange
