#include "fathom/core/program.hpp"

#include <cstdlib>

#include <gmock/gmock.h>

#include "core/few_descriptors.hpp"
#include "fathom/core/environment_error.hpp"
#include "fathom/core/system.hpp"

namespace fathom {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

template <class Call>
std::string failure_of(Call call) {
  try {
    call();
  } catch (const ProgramFailure& failure) {
    return failure.what();
  }
  return "none";
}

TEST(WordsOfCommand, AreDividedBySpacesOutsideOfQuotes) {
  EXPECT_THAT(words_of_command("  solver\t{input}  'a b'\"c 'd\" '' "),
              ElementsAre("solver", "{input}", "a bc 'd", ""));
  EXPECT_THAT(words_of_command(" "), ElementsAre());
  EXPECT_THROW(words_of_command("a \"b"), InputError);
}

TEST(Program, AnswersMoreThanAPipeHoldsWhileItIsWrittenTo) {
  Program program({"cat"});
  std::string lines;
  for (int i = 0; i < 200'000; ++i) lines += "line " + std::to_string(i) + "\n";
  program.send(lines);
  for (int i = 0; i < 200'000; ++i) ASSERT_EQ(program.next_line(), "line " + std::to_string(i));
  program.finish();
  EXPECT_GT(program.processor_s(), 0.0);
}

TEST(Program, SaysHowItEndedAndWhatItPrintedLast) {
  EXPECT_THAT(failure_of([] {
                Program({"sh", "-c", "echo bad >&2; exit 4"}).finish();
              }),
              AllOf(HasSubstr("status 4"), HasSubstr("bad")));
  EXPECT_THAT(failure_of([] {
                Program({"sh", "-c", "kill -SEGV $$"}).finish();
              }),
              HasSubstr("signal 11"));
  EXPECT_THAT(failure_of([] { Program({"true"}).next_line(); }), HasSubstr("ended"));
  EXPECT_THAT(failure_of([] {
                Program({"head", "-c", "3000000", "/dev/zero"}).next_line();
              }),
              HasSubstr("a line without end"));
}

// The end is its own, whatever it has left running.
TEST(Program, ThatLeavesAnotherWithItsStreamsHasEnded) {
  EXPECT_THAT(failure_of([] {
                Program({"sh", "-c", "sleep 30 & exit 3"}).next_line();
              }),
              HasSubstr("ended: status 3"));
  EXPECT_THAT(failure_of([] {
                Program program({"sh", "-c", "exec 3<&0; sleep 30 <&3 & exit 3"});
                for (int i = 0; i < 10; ++i) program.send(std::string(100'000, 'x'));
              }),
              HasSubstr("ended: status 3"));
}

// Without a signal to this process.
TEST(Program, OneThatReadsNoMoreIsAFailure) {
  EXPECT_THAT(failure_of([] {
                Program program({"sh", "-c", "exec <&-; sleep 0.2; kill -9 $$"});
                for (int i = 0; i < 1000; ++i) program.send(std::string(100'000, 'x'));
              }),
              AllOf(HasSubstr("reads no more"), HasSubstr("signal 9")));
}

// Before it was the program it was this process, whose memory is not its own.
TEST(Program, ItsPeakIsItsOwn) {
  const std::vector<char> mine(200 << 20, 1);
  Program small({"true"});
  small.finish();
  EXPECT_LT(small.peak_bytes(), 20 << 20) << mine.size();
  Program large({"dd", "if=/dev/zero", "of=/dev/null", "bs=400M", "count=1"});
  large.finish();
  EXPECT_GT(large.peak_bytes(), 390 << 20);
  EXPECT_LT(large.peak_bytes(), 440 << 20);
}

TEST(Program, ItsTimeIsAmongThatOfTheProcessThatWaitedForIt) {
  const double before_s = processor_seconds();
  Program program({"dd", "if=/dev/zero", "of=/dev/null", "bs=1M", "count=1000"});
  program.finish();
  EXPECT_GT(program.processor_s(), 0.0);
  EXPECT_GE(processor_seconds() - before_s, program.processor_s());
}

TEST(Program, WorksWithOneThreadUnlessTheEnvironmentSaysOtherwise) {
  ::unsetenv("OMP_NUM_THREADS");
  ::unsetenv("OPENBLAS_NUM_THREADS");
  Program program({"sh", "-c", "echo $OMP_NUM_THREADS $OPENBLAS_NUM_THREADS"});
  EXPECT_EQ(program.next_line(), "1 1");
}

TEST(Program, WhatIsNotThereIsBadInput) {
  EXPECT_THROW(find_program("no-such-program"), InputError);
  EXPECT_THROW(find_program("/etc/passwd"), InputError);
  EXPECT_EQ(find_program("/bin/sh"), "/bin/sh");
}

TEST(Program, ThatTheSystemDoesNotStartIsAFaultOfTheEnvironment) {
  EXPECT_THROW(Program({"no-such-program"}), EnvironmentError);
  const test::FewDescriptors none_left;
  EXPECT_THROW(Program({"true"}), EnvironmentError);
}

TEST(ProgramWork, IsApartFromThatOfTheThread) {
  reset_program_work();
  {
    ForProgram work;
    work.add_processor_s(2.0);
    work.add_start_up_s(0.5);
    work.note_peak(100);
    work.note_peak(50);
  }
  EXPECT_EQ(program_work().processor_s, 2.0);
  EXPECT_EQ(program_work().start_up_s, 0.5);
  EXPECT_EQ(program_work().peak_bytes, 100);
  EXPECT_GT(program_work().waited_s, 0.0);
  reset_program_work();
  EXPECT_EQ(program_work().waited_s, 0.0);
}

}  // namespace
}  // namespace fathom
