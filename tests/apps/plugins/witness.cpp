// Leaves a trace of having been loaded: an empty file where FATHOM_TEST_WITNESS says.

#include <cstdlib>
#include <fstream>

namespace {

[[gnu::constructor]] void leave_a_trace() {
  if (const char* const file = std::getenv("FATHOM_TEST_WITNESS")) std::ofstream{file};
}

}  // namespace
