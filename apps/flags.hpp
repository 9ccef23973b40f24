#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "fathom/core/input_error.hpp"
#include "fathom/core/options.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace fathom {

/// A bad value of a flag: --help of the command says more.
class FlagError : public InputError {
 public:
  using InputError::InputError;
};

/// One flag of a command, to say more of it.
class Flag {
 public:
  explicit Flag(CLI::Option& option) : option_(&option) {}

  const Flag& required() const;
  /// Never together with the other.
  const Flag& excludes(const Flag& other) const;
  bool is_given() const;

 private:
  CLI::Option* option_;
};

/// A command of the program with its arguments and flags, bound to fields that must outlive the
/// parsing. A field's value is the default that --help shows. Numbers are read by parse_real and
/// parse_integer, as those of files are: `010` is ten. A bad value throws FlagError with the flag,
/// what was given and what would be right. CLI11 is behind this, in one file: it takes seconds to
/// compile.
class Command {
 public:
  Command(CLI::App& program, const std::string& name, const std::string& help,
          const std::string& footer);

  /// A word that must be given, and not empty.
  Flag argument(const std::string& name, std::string& field, const std::string& help);
  /// The same, one of several words.
  Flag argument(const std::string& name, std::string& field,
                const std::vector<std::string>& choices, const std::string& help);

  /// One word or more.
  Flag arguments(const std::string& name, std::vector<std::string>& field, const std::string& help);
  /// Any number of words.
  Flag optional_arguments(const std::string& name, std::vector<std::string>& field,
                          const std::string& help);

  /// `value_name` stands for the value in --help: "DIR", "N".
  Flag text(const std::string& name, std::string& field, const std::string& value_name,
            const std::string& help);
  /// Each use of the flag adds one.
  Flag texts(const std::string& name, std::vector<std::string>& field,
             const std::string& value_name, const std::string& help);
  Flag choice(const std::string& name, std::string& field, const std::vector<std::string>& choices,
              const std::string& value_name, const std::string& help);
  Flag real(const std::string& name, double& field, Range range, const std::string& value_name,
            const std::string& help);
  Flag real(const std::string& name, std::optional<double>& field, Range range,
            const std::string& value_name, const std::string& help);
  /// The first use takes the place of the field's default, each further one adds one.
  Flag reals(const std::string& name, std::vector<double>& field, Range range,
             const std::string& value_name, const std::string& help);
  Flag integer(const std::string& name, int& field, Range range, const std::string& value_name,
               const std::string& help);
  Flag integer(const std::string& name, std::optional<int>& field, Range range,
               const std::string& value_name, const std::string& help);
  Flag integers(const std::string& name, std::vector<std::size_t>& field, Range range,
                const std::string& value_name, const std::string& help);
  Flag boolean(const std::string& name, bool& field, const std::string& help);
  /// --quiet, of a command whose output is what it prints: print() says nothing.
  void quiet();

  /// The flags that were given, by their names.
  std::vector<std::string> given() const;

  /// Not listed by --help of the program.
  void hidden();

  /// What the command does, once all is read.
  void on_run(std::function<void()> action);

 private:
  using Values = std::vector<std::string>;

  Flag add(const std::string& name, const std::string& value_name, const std::string& help,
           const std::string& default_text, const std::function<void(const Values&)>& read);

  CLI::App* command_;
};

}  // namespace fathom
