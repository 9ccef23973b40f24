#include "apps/command_line.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fcntl.h>
#include <fstream>
#include <sys/resource.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include "fathom/core/files.hpp"

namespace fathom::test {
namespace {

namespace fs = std::filesystem;

// In the child: into the folder, output into files, and the program in its place.
[[noreturn]] void become_fathom(const fs::path& folder, const fs::path& out, const fs::path& err,
                                const Surroundings& surroundings,
                                std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "fathom");
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  constexpr int kFlags = O_WRONLY | O_CREAT | O_TRUNC;
  // No test may find what another one registered, nor leave anything with the user.
  ::setenv("FATHOM_CACHE", (out.parent_path() / "cache").c_str(), 1);
  for (const auto& [name, value] : surroundings.environment) {
    ::setenv(name.c_str(), value.c_str(), 1);
  }
  const bool is_redirected = !surroundings.standard_output.empty();
  const int out_file =
      ::open(is_redirected ? surroundings.standard_output.c_str() : out.c_str(), kFlags, 0600);
  const int err_file = ::open(err.c_str(), kFlags, 0600);
  const auto bound = [](auto resource, rlim_t most) {
    const rlimit limit{most, most};
    if (most > 0 && ::setrlimit(resource, &limit) != 0) ::_exit(127);
  };
  bound(RLIMIT_AS, surroundings.address_space_bytes);
  bound(RLIMIT_CPU, surroundings.processor_s);
  bound(RLIMIT_FSIZE, surroundings.file_bytes);
  if (::chdir(folder.c_str()) == 0 && ::dup2(out_file, 1) == 1 && ::dup2(err_file, 2) == 2) {
    ::execv(surroundings.program.c_str(), argv.data());
  }
  ::_exit(127);
}

}  // namespace

Ended CommandLine::fathom(const Arguments& arguments,
                          const std::function<void(pid_t)>& while_running) const {
  const TemporaryFolder output;
  const pid_t child = ::fork();
  if (child == 0) {
    become_fathom(folder_.path(), output / "out", output / "err", surroundings_, arguments);
  }
  int status = 0;
  while (::waitpid(child, &status, while_running ? WNOHANG : 0) == 0) {
    while_running(child);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status),
          surroundings_.standard_output.empty() ? read_file(output / "out") : "",
          read_file(output / "err")};
}

std::string without_notes(std::string errors) {
  while (errors.starts_with("fathom: note: ")) errors.erase(0, errors.find('\n') + 1);
  return errors;
}

Ended CommandLine::fathom_done(const Arguments& arguments) const {
  const Ended ended = fathom(arguments);
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(without_notes(ended.err), "");
  return ended;
}

std::string CommandLine::refusal(const Arguments& arguments) const {
  const std::set<std::string> before = tree();
  Ended ended = fathom(arguments);
  EXPECT_EQ(ended.status, 2) << ended.err;
  EXPECT_EQ(ended.out, "");
  ended.err = without_notes(ended.err);
  EXPECT_EQ(tree(), before);
  const std::string opening = "fathom: error: ";
  EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
  EXPECT_TRUE(ended.err.starts_with(opening) && ended.err.ends_with("\n")) << ended.err;
  return ended.err.substr(std::min(opening.size(), ended.err.size()));
}

std::string CommandLine::write(const std::string& name, const std::string& content) const {
  fs::create_directories(path(name).parent_path());
  std::ofstream(path(name), std::ios::binary) << content;
  return name;
}

nlohmann::json CommandLine::json_of(const std::string& name) const {
  return nlohmann::json::parse(read_file(path(name)));
}

std::set<std::string> CommandLine::tree() const {
  std::set<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder_.path())) {
    names.insert(entry.path().lexically_relative(folder_.path()).string());
  }
  return names;
}

}  // namespace fathom::test
