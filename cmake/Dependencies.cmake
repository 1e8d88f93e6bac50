# Finds everything the engine links, all of it from Debian's packages.
find_package(Threads REQUIRED)
find_package(SPIRV-Tools REQUIRED)
find_package(SPIRV-Tools-opt REQUIRED)
find_package(SPIRV-Tools-link REQUIRED)
find_package(glslang REQUIRED)
find_package(glm REQUIRED)
find_package(TinyGLTF REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(draco REQUIRED)
find_package(meshoptimizer REQUIRED)
find_package(OpenEXR REQUIRED)
find_package(PNG REQUIRED)
find_library(TURBOJPEG_LIBRARY turbojpeg REQUIRED)
find_library(WEBP_LIBRARY webp REQUIRED)
find_path(VOLK_INCLUDE_DIR volk.h REQUIRED)
find_path(XXHASH_INCLUDE_DIR xxhash.h REQUIRED)

add_library(photonloupe_dependencies INTERFACE)
target_include_directories(photonloupe_dependencies SYSTEM INTERFACE ${VOLK_INCLUDE_DIR} ${XXHASH_INCLUDE_DIR})
target_link_libraries(photonloupe_dependencies INTERFACE
  ${CMAKE_DL_LIBS} Threads::Threads
  glslang::glslang glslang::SPIRV glslang::glslang-default-resource-limits
  glm::glm TinyGLTF::TinyGLTF nlohmann_json::nlohmann_json draco::draco
  meshoptimizer::meshoptimizer OpenEXR::OpenEXR PNG::PNG ${TURBOJPEG_LIBRARY} ${WEBP_LIBRARY})
