// A COLMAP text model: images.txt and, below a line `====`, cameras.txt.
#include "fathom/datasets/import.hpp"
#include "support/fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fathom;
  static const fuzz::Folder folder("colmap");
  constexpr std::string_view kBorder = "====\n";
  const std::string_view text = fuzz::text_of(data, size);
  const std::size_t border = text.find(kBorder);
  folder.write("images.txt", text.substr(0, border));
  std::filesystem::remove(folder.path() / "cameras.txt");
  if (border != std::string_view::npos) {
    folder.write("cameras.txt", text.substr(border + kBorder.size()));
  }
  fuzz::is_taken([&] {
    fuzz::require(import_kind(folder.path()) == ImportKind::colmap, "it is a COLMAP model");
    import_colmap(folder.path(), {}, folder.path() / "out");
  });
  return 0;
}
