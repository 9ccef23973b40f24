#pragma once

#include <cstddef>
#include <string>

namespace fathom::test {

/// Of a session that does a shard of `runs` runs, of a study of two estimators: by default of six
/// cells with two trials each.
inline std::string manifest(std::size_t index, std::size_t of, std::size_t runs,
                            const std::string& cpu = "one kind", std::size_t trials = 2,
                            const std::string& places = "[0, 1, 2, 3, 4, 5]") {
  const auto number = [](std::size_t value) { return std::to_string(value); };
  return R"({"command_line": "fathom compare s.yaml --shard )" + number(index) + "/" + number(of) +
         " --out shard-" + number(index) + R"(", "machine": {"cpu": ")" + cpu +
         R"("}, "shard": {"index": )" + number(index) + R"(, "of": )" + number(of) +
         R"(, "runs": )" + number(runs) + R"(, "surveys": 1, "trials": )" + number(trials) +
         R"(, "places": )" + places + R"(, "first": )" + number((index - 1) * (runs / 2)) +
         R"(, "count": )" + number(runs / 2) + "}}\n";
}

}  // namespace fathom::test
