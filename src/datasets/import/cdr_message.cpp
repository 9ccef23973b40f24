#include "fathom/core/features.hpp"
#include "fathom/core/input_error.hpp"
#include "message_reader.hpp"

#ifdef FATHOM_FASTCDR

#include <cstddef>
#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>
#include <fastcdr/config.h>
#include <fastcdr/exceptions/Exception.h>

namespace fathom {
namespace {

using eprosima::fastcdr::Cdr;
using eprosima::fastcdr::FastBuffer;

// Names that version 2 has changed.
#if FASTCDR_VERSION_MAJOR >= 2
constexpr auto kVersion = eprosima::fastcdr::CdrVersion::DDS_CDR;
const char* position_of(Cdr& cdr) {
  return cdr.get_current_position();
}
#else
constexpr auto kVersion = Cdr::DDS_CDR;
const char* position_of(Cdr& cdr) {
  return cdr.getCurrentPosition();
}
#endif

class CdrMessage : public MessageReader {
 public:
  // The buffer is only read, but Fast CDR has one kind of buffer.
  explicit CdrMessage(std::string_view bytes)
      : end_(bytes.data() + bytes.size()),
        buffer_(const_cast<char*>(bytes.data()), bytes.size()),
        cdr_(buffer_, Cdr::DEFAULT_ENDIAN, kVersion) {
    guarded([this] { cdr_.read_encapsulation(); });
  }

  std::uint8_t u8() override { return number<std::uint8_t>(); }
  std::uint32_t u32() override { return number<std::uint32_t>(); }
  float f32() override { return number<float>(); }
  double f64() override { return number<double>(); }
  std::string text() override {
    std::string value;
    guarded([&] { cdr_.deserialize(value); });
    return value;
  }
  std::string_view bytes() override {
    const std::size_t size = u32();
    const char* const begin = position_of(cdr_);
    if (size > static_cast<std::size_t>(end_ - begin)) too_short();
    cdr_.jump(size);
    return {begin, size};
  }
  void skip_sequence_number() override {}

 private:
  [[noreturn]] static void too_short() {
    throw InputError("a message is shorter than its type says");
  }

  template <class Action>
  static void guarded(const Action& action) {
    try {
      action();
    } catch (const eprosima::fastcdr::exception::Exception&) {
      too_short();
    }
  }

  template <class Number>
  Number number() {
    Number value{};
    guarded([&] { cdr_.deserialize(value); });
    return value;
  }

  const char* end_;
  FastBuffer buffer_;
  Cdr cdr_;
};

}  // namespace

std::unique_ptr<MessageReader> cdr_message(std::string_view bytes) {
  return std::make_unique<CdrMessage>(bytes);
}

void require_cdr() {}

}  // namespace fathom

#else

namespace fathom {

void require_cdr() {
  throw InputError("bags of ROS 2: " + refusal_without("fastcdr"));
}

std::unique_ptr<MessageReader> cdr_message(std::string_view /*bytes*/) {
  require_cdr();
  return nullptr;
}

}  // namespace fathom

#endif
