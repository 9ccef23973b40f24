#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace fathom {

/// Reads the fields of one serialised message in the order of its definition. Both generations of
/// ROS have the same definitions but for the header's sequence number, so that each is described
/// once (bag_messages.hpp). All calls throw InputError where the message ends too early.
class MessageReader {
 public:
  virtual ~MessageReader() = default;
  virtual std::uint8_t u8() = 0;
  virtual std::uint32_t u32() = 0;
  virtual float f32() = 0;
  virtual double f64() = 0;
  virtual std::string text() = 0;
  /// A `uint8[]`; it refers to the message.
  virtual std::string_view bytes() = 0;
  /// The `seq` of a header, which ROS 2 does not have.
  virtual void skip_sequence_number() = 0;
};

/// A message of ROS 1: little-endian, packed. It refers to `bytes`.
std::unique_ptr<MessageReader> ros1_message(std::string_view bytes);

/// A message of ROS 2: CDR, whose first bytes say the byte order. It refers to `bytes`. Throws
/// InputError where they are no CDR, or where Fathom was built without Fast CDR.
std::unique_ptr<MessageReader> cdr_message(std::string_view bytes);

/// Throws InputError that names the package, where Fathom was built without Fast CDR.
void require_cdr();

}  // namespace fathom
