#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace fathom {

/// Which readings of a sensor are kept, and the kept ones around any: found at once however many
/// between them are left out.
class KeptReadings {
 public:
  KeptReadings() = default;
  explicit KeptReadings(std::vector<bool> kept) : kept_(std::move(kept)) {
    for (std::size_t i = 0; i < kept_.size(); ++i) {
      // As many kept ones as lie before i.
      ranks_.push_back(indices_.size());
      if (kept_[i]) indices_.push_back(i);
    }
  }

  bool operator[](std::size_t i) const { return kept_[i]; }
  const std::vector<bool>& all() const { return kept_; }

  /// The nth kept one at or before reading i, from 0.
  std::optional<std::size_t> before(std::size_t i, std::size_t nth = 0) const {
    const std::size_t count = ranks_[i] + (kept_[i] ? 1 : 0);
    return nth < count ? std::optional(indices_[count - 1 - nth]) : std::nullopt;
  }
  /// The nth kept one at or after reading i, which may be the end.
  std::optional<std::size_t> after(std::size_t i, std::size_t nth = 0) const {
    const std::size_t place = (i < ranks_.size() ? ranks_[i] : indices_.size()) + nth;
    return place < indices_.size() ? std::optional(indices_[place]) : std::nullopt;
  }

 private:
  std::vector<bool> kept_;
  std::vector<std::size_t> indices_;  ///< of the kept ones
  std::vector<std::size_t> ranks_;
};

}  // namespace fathom
