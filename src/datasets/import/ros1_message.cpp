#include <bit>
#include <cstddef>
#include <cstring>

#include "fathom/core/input_error.hpp"
#include "message_reader.hpp"

namespace fathom {
namespace {

static_assert(std::endian::native == std::endian::little, "ROS 1 messages are little-endian");

class Ros1Message : public MessageReader {
 public:
  explicit Ros1Message(std::string_view bytes) : rest_(bytes) {}

  std::uint8_t u8() override { return number<std::uint8_t>(); }
  std::uint32_t u32() override { return number<std::uint32_t>(); }
  float f32() override { return number<float>(); }
  double f64() override { return number<double>(); }
  std::string text() override { return std::string(take(u32())); }
  std::string_view bytes() override { return take(u32()); }
  void skip_sequence_number() override { u32(); }

 private:
  std::string_view take(std::size_t size) {
    if (size > rest_.size()) throw InputError("a message is shorter than its type says");
    const std::string_view taken = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return taken;
  }

  template <class Number>
  Number number() {
    Number value;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }

  std::string_view rest_;
};

}  // namespace

std::unique_ptr<MessageReader> ros1_message(std::string_view bytes) {
  return std::make_unique<Ros1Message>(bytes);
}

}  // namespace fathom
