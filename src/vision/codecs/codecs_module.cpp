// The module of the program that is loaded with the first picture.
#include "fathom/vision/picture_codecs.hpp"
#include "picture_codecs.hpp"

extern "C" {
[[gnu::visibility("default")]] extern const fathom::PictureCodecs fathom_picture_codecs;
const fathom::PictureCodecs fathom_picture_codecs{fathom::decode_picture, fathom::encode_picture};
}
