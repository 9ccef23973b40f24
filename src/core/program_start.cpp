#include "program_start.hpp"

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <spawn.h>
#include <sstream>
#include <unistd.h>

#include "fathom/core/environment_error.hpp"
#include "fathom/core/program.hpp"

namespace fathom {
namespace {

// The environment, one thread for each library that the variables of have not been set.
std::vector<std::string> environment_of_one_thread() {
  std::vector<std::string> all;
  for (char** one = environ; *one != nullptr; ++one) all.emplace_back(*one);
  for (const char* name : {"OMP_NUM_THREADS", "OMP_THREAD_LIMIT", "OPENBLAS_NUM_THREADS",
                           "MKL_NUM_THREADS", "GOTO_NUM_THREADS"}) {
    if (std::getenv(name) == nullptr) all.push_back(std::string(name) + "=1");
  }
  return all;
}

std::vector<char*> pointers_to(std::vector<std::string>& words) {
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  return pointers;
}

bool is_program(const std::filesystem::path& file) {
  return std::filesystem::is_regular_file(file) && ::access(file.c_str(), X_OK) == 0;
}

}  // namespace

std::vector<std::string> words_of_command(std::string_view line) {
  std::vector<std::string> words;
  char quote = 0;
  bool is_in_word = false;
  for (const char letter : line) {
    if (quote == 0 && (letter == ' ' || letter == '\t')) {
      is_in_word = false;
      continue;
    }
    if (!is_in_word) words.emplace_back();
    is_in_word = true;
    if (quote == 0 && (letter == '"' || letter == '\'')) {
      quote = letter;
    } else if (letter == quote) {
      quote = 0;
    } else {
      words.back() += letter;
    }
  }
  if (quote != 0) throw InputError(std::string("a quote is not closed: ") + quote);
  return words;
}

std::string find_program(const std::string& name) {
  if (name.find('/') != std::string::npos) {
    if (is_program(name)) return name;
    throw EnvironmentError("'" + name + "': there is no such program, or it may not be executed");
  }
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "/usr/local/bin:/usr/bin:/bin" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::filesystem::path file = std::filesystem::path(folder.empty() ? "." : folder) / name;
    if (is_program(file)) return file.string();
  }
  throw EnvironmentError("'" + name + "': there is no such program in PATH");
}

ProgramPipes::ProgramPipes() {
  for (auto& pair : pairs_) {
    if (::pipe2(pair.data(), O_CLOEXEC) == 0) continue;
    const int error = errno;
    for (const auto& opened : pairs_) {
      for (const int end : opened) {
        if (end >= 0) ::close(end);
      }
    }
    throw EnvironmentError("a program's input and output", "no pipe can be made", error);
  }
}

ProgramPipes::~ProgramPipes() {
  for (std::size_t stream = 0; stream < pairs_.size(); ++stream) ::close(theirs(stream));
}

// As a shell starts one, whatever this thread has blocked.
int start_program(const std::string& file, std::vector<std::string> words,
                  const ProgramPipes& pipes) {
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  for (int stream = 0; stream < 3; ++stream) {
    ::posix_spawn_file_actions_adddup2(&actions, pipes.theirs(static_cast<std::size_t>(stream)),
                                       stream);
  }
  posix_spawnattr_t attributes;
  ::posix_spawnattr_init(&attributes);
  sigset_t none;
  ::sigemptyset(&none);
  sigset_t all;
  ::sigfillset(&all);
  ::posix_spawnattr_setsigmask(&attributes, &none);
  ::posix_spawnattr_setsigdefault(&attributes, &all);
  ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  std::vector<std::string> environment = environment_of_one_thread();
  pid_t id = -1;
  const int error = ::posix_spawn(&id, file.c_str(), &actions, &attributes,
                                  pointers_to(words).data(), pointers_to(environment).data());
  ::posix_spawn_file_actions_destroy(&actions);
  ::posix_spawnattr_destroy(&attributes);
  if (error != 0) {
    throw EnvironmentError("'" + file + "'", "the system does not start it", error);
  }
  return id;
}

}  // namespace fathom
