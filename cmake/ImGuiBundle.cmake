# Dear ImGui (docking), ImPlot and ImGuiColorTextEdit from the pinned source package imgui-bundle, checked by its hash.
# IMGUI_BUNDLE_DIR names an unpacked package to take instead; nothing is fetched then.
find_package(Python COMPONENTS Interpreter REQUIRED)
find_package(glfw3 REQUIRED)

set(BUNDLE_PIN ${CMAKE_CURRENT_LIST_DIR}/imgui-bundle.txt)
file(READ ${BUNDLE_PIN} BUNDLE_LINE)
string(REGEX MATCH "imgui-bundle==([0-9.]+) --hash=sha256:([0-9a-f]+)" BUNDLE_MATCH "${BUNDLE_LINE}")
set(BUNDLE_VERSION ${CMAKE_MATCH_1})
set(BUNDLE_HASH ${CMAKE_MATCH_2})
set(BUNDLE_MENDED 1) # raised when what is mended below changes

if(NOT IMGUI_BUNDLE_DIR)
  set(IMGUI_BUNDLE_DIR ${CMAKE_BINARY_DIR}/imgui-bundle)
  if(EXISTS ${IMGUI_BUNDLE_DIR}/hash)
    file(READ ${IMGUI_BUNDLE_DIR}/hash UNPACKED_HASH)
  endif()
  if(NOT "${UNPACKED_HASH}" STREQUAL "${BUNDLE_HASH}-${BUNDLE_MENDED}")
    set(BUNDLE_DOWNLOAD ${CMAKE_BINARY_DIR}/imgui-bundle-download)
    file(REMOVE_RECURSE ${IMGUI_BUNDLE_DIR} ${BUNDLE_DOWNLOAD})
    message(STATUS "Fetching imgui-bundle ${BUNDLE_VERSION}")
    execute_process(
      COMMAND ${Python_EXECUTABLE} -m pip download --quiet --disable-pip-version-check --no-deps --no-binary :all:
              --no-build-isolation --require-hashes --requirement ${BUNDLE_PIN} --dest ${BUNDLE_DOWNLOAD}
      RESULT_VARIABLE BUNDLE_FAILED OUTPUT_VARIABLE BUNDLE_OUTPUT ERROR_VARIABLE BUNDLE_OUTPUT)
    file(GLOB BUNDLE_ARCHIVE ${BUNDLE_DOWNLOAD}/*.tar.gz)
    if(BUNDLE_FAILED OR NOT BUNDLE_ARCHIVE)
      message(FATAL_ERROR "imgui-bundle ${BUNDLE_VERSION} could not be fetched:\n${BUNDLE_OUTPUT}\n"
                          "Check the network, or set IMGUI_BUNDLE_DIR to the unpacked source package.")
    endif()
    file(ARCHIVE_EXTRACT INPUT ${BUNDLE_ARCHIVE} DESTINATION ${BUNDLE_DOWNLOAD}
         PATTERNS "*/external/imgui/imgui/*" "*/external/implot/implot/*" "*/external/ImGuiColorTextEdit/*" "*/LICENSE")
    file(RENAME ${BUNDLE_DOWNLOAD}/imgui_bundle-${BUNDLE_VERSION} ${IMGUI_BUNDLE_DIR})
    file(REMOVE_RECURSE ${BUNDLE_DOWNLOAD})
    # Its binary searches read one entry past the end of their tables.
    set(EDITOR_SOURCE ${IMGUI_BUNDLE_DIR}/external/ImGuiColorTextEdit/ImGuiColorTextEdit/TextEditor.cpp)
    file(READ ${EDITOR_SOURCE} EDITOR_TEXT)
    string(REPLACE "std::end(table);" "std::end(table) - 1;" EDITOR_TEXT "${EDITOR_TEXT}")
    file(WRITE ${EDITOR_SOURCE} "${EDITOR_TEXT}")
    file(WRITE ${IMGUI_BUNDLE_DIR}/hash ${BUNDLE_HASH}-${BUNDLE_MENDED})
  endif()
endif()

set(IMGUI_DIR ${IMGUI_BUNDLE_DIR}/external/imgui/imgui)
set(IMPLOT_DIR ${IMGUI_BUNDLE_DIR}/external/implot/implot)
set(EDITOR_DIR ${IMGUI_BUNDLE_DIR}/external/ImGuiColorTextEdit/ImGuiColorTextEdit)
set(PHOTONLOUPE_FONT_DIR ${IMGUI_DIR}/misc/fonts)

add_library(photonloupe_imgui STATIC
  ${IMGUI_DIR}/imgui.cpp ${IMGUI_DIR}/imgui_draw.cpp ${IMGUI_DIR}/imgui_tables.cpp ${IMGUI_DIR}/imgui_widgets.cpp
  ${IMGUI_DIR}/imgui_stacklayout.cpp ${IMGUI_DIR}/misc/cpp/imgui_stdlib.cpp
  ${IMGUI_DIR}/backends/imgui_impl_glfw.cpp ${IMGUI_DIR}/backends/imgui_impl_vulkan.cpp
  ${IMPLOT_DIR}/implot.cpp ${IMPLOT_DIR}/implot_items.cpp ${EDITOR_DIR}/TextEditor.cpp)
target_include_directories(photonloupe_imgui SYSTEM PUBLIC
  ${IMGUI_DIR} ${IMGUI_DIR}/backends ${IMGUI_DIR}/misc/cpp ${IMPLOT_DIR} ${EDITOR_DIR})
target_compile_definitions(photonloupe_imgui PUBLIC IMGUI_IMPL_VULKAN_NO_PROTOTYPES IMGUI_DISABLE_OBSOLETE_FUNCTIONS
                           GLFW_INCLUDE_NONE)
target_compile_options(photonloupe_imgui PRIVATE -w)
target_link_libraries(photonloupe_imgui PUBLIC glfw)
