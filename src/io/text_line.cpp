#include "io/text_line.hpp"

#include <ft2build.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <vector>

#include "io/fonts/fonts.hpp"
#include "roadstereo/error.hpp"
#include FT_FREETYPE_H

namespace roadstereo::io {
namespace {

constexpr int per_pixel = 64;  // FreeType's units: 26.6 fixed point

class Font {
 public:
  Font() {
    const auto* const bytes = reinterpret_cast<const FT_Byte*>(fonts::sans.data());
    if (FT_Init_FreeType(&library_) != 0) fail("FreeType cannot be initialised");
    if (FT_New_Memory_Face(library_, bytes, static_cast<FT_Long>(fonts::sans.size()), 0, &face_) != 0) {
      FT_Done_FreeType(library_);
      fail("FreeType cannot read the embedded font");
    }
  }
  ~Font() {
    FT_Done_Face(face_);
    FT_Done_FreeType(library_);
  }
  Font(const Font&) = delete;
  Font& operator=(const Font&) = delete;

  void set_capital_height(int height) {
    constexpr double capital_em = 0.729;
    FT_Set_Char_Size(face_, 0, std::max<FT_F26Dot6>(per_pixel, std::lround(height * per_pixel / capital_em)), 72, 72);
  }

  /// The rendered glyph, valid until the next call; nullptr if there is none.
  FT_GlyphSlot render(char32_t character) {
    FT_UInt index = FT_Get_Char_Index(face_, character);
    if (index == 0) index = FT_Get_Char_Index(face_, '?');
    return FT_Load_Glyph(face_, index, FT_LOAD_RENDER | FT_LOAD_TARGET_LIGHT) == 0 ? face_->glyph : nullptr;
  }

 private:
  FT_Library library_ = nullptr;
  FT_Face face_ = nullptr;
};

/// Characters of UTF-8 text; U+FFFD for bytes that are none.
std::u32string decode(std::string_view text) {
  constexpr char32_t invalid = 0xFFFD;
  std::u32string characters;
  for (std::size_t i = 0; i < text.size();) {
    const auto first = static_cast<unsigned char>(text[i++]);
    const int further = first < 0x80   ? 0
                        : first < 0xC0 ? -1
                        : first < 0xE0 ? 1
                        : first < 0xF0 ? 2
                        : first < 0xF8 ? 3
                                       : -1;
    char32_t character = further <= 0 ? first : first & (0x3FU >> static_cast<unsigned>(further));
    bool valid = further >= 0;
    for (int k = 0; k < further && valid; ++k) {
      valid = i < text.size() && (static_cast<unsigned char>(text[i]) & 0xC0U) == 0x80U;
      if (valid) character = (character << 6U) | (static_cast<unsigned char>(text[i++]) & 0x3FU);
    }
    characters.push_back(valid ? character : invalid);
  }
  return characters;
}

/// A glyph of the line; `corner` relative to the left end of the base line.
struct PlacedGlyph {
  cv::Mat cover;
  cv::Point corner;
};

}  // namespace

TextLine render_line(const std::string& text, int height) {
  Font font;
  font.set_capital_height(height);
  std::vector<PlacedGlyph> glyphs;
  cv::Rect box;
  FT_Pos pen = 0;
  for (const char32_t character : decode(text)) {
    const FT_GlyphSlot glyph = font.render(character);
    if (glyph == nullptr) continue;
    const FT_Bitmap& bitmap = glyph->bitmap;
    if (bitmap.width > 0 && bitmap.rows > 0) {
      const cv::Mat cover(static_cast<int>(bitmap.rows), static_cast<int>(bitmap.width), CV_8UC1, bitmap.buffer,
                          static_cast<std::size_t>(bitmap.pitch));
      const cv::Point corner(static_cast<int>((pen + per_pixel / 2) / per_pixel) + glyph->bitmap_left,
                             -glyph->bitmap_top);
      glyphs.push_back({cover.clone(), corner});
      box = box.empty() ? cv::Rect(corner, cover.size()) : box | cv::Rect(corner, cover.size());
    }
    pen += glyph->advance.x;
  }
  TextLine line{cv::Mat(box.size(), CV_8UC1, cv::Scalar(0)), box.tl(),
                static_cast<int>((pen + per_pixel - 1) / per_pixel)};
  for (const PlacedGlyph& glyph : glyphs) {
    cv::Mat part = line.cover(cv::Rect(glyph.corner - box.tl(), glyph.cover.size()));
    cv::max(part, glyph.cover, part);
  }
  return line;
}

}  // namespace roadstereo::io
