// SPDX-License-Identifier: Apache-2.0
// Roboto for text and Cousine for code (both Apache-2.0), taken in by the assembler from imgui-bundle.
#include "studio/fonts.h"

#include <imgui.h>

#define TAKE_IN(symbol, file)                                                                                          \
    asm(".section .rodata\n.balign 16\n.global " symbol "\n" symbol ":\n.incbin \"" PHOTONLOUPE_FONT_DIR "/" file      \
        "\"\n.global " symbol "_end\n" symbol "_end:\n.byte 0\n.text\n")

TAKE_IN("photonloupe_text_font", "Roboto-Medium.ttf");
TAKE_IN("photonloupe_code_font", "Cousine-Regular.ttf");

extern "C" const unsigned char photonloupe_text_font[], photonloupe_text_font_end[];
extern "C" const unsigned char photonloupe_code_font[], photonloupe_code_font_end[];

namespace photonloupe::studio {
namespace {

constexpr float TEXT_SIZE = 15.0f; // pixels at scale 1
constexpr float CODE_SIZE = 14.0f;

ImFont* add_font(const unsigned char* begin, const unsigned char* end, float size) {
    ImFontConfig config;
    config.FontDataOwnedByAtlas = false;
    return ImGui::GetIO().Fonts->AddFontFromMemoryTTF(const_cast<unsigned char*>(begin), static_cast<int>(end - begin),
                                                      size, &config);
}

} // namespace

Fonts load_fonts(float scale) {
    Fonts fonts;
    fonts.text = add_font(photonloupe_text_font, photonloupe_text_font_end, TEXT_SIZE * scale);
    fonts.code = add_font(photonloupe_code_font, photonloupe_code_font_end, CODE_SIZE * scale);
    return fonts;
}

} // namespace photonloupe::studio
