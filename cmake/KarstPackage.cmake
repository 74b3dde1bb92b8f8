# Debian packages, a component each: `make deb`, or cpack in a build folder. What they depend on, dpkg-shlibdeps says.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME karst)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package has its own
set(CPACK_PACKAGE_CONTACT "The karst authors <karst@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_COMPONENTS_ALL karst sdk doc)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)

set(CPACK_DEBIAN_KARST_PACKAGE_NAME karst)
set(CPACK_DEBIAN_KARST_PACKAGE_SECTION science)
set(CPACK_DEBIAN_KARST_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_KARST_PACKAGE_RECOMMENDS "karst-doc")
set(CPACK_DEBIAN_KARST_PACKAGE_SUGGESTS "karst-sdk, librsvg2-bin, slurm-client, survex")
set(CPACK_DEBIAN_KARST_DESCRIPTION
"exploration policies for cave-flying UAVs: fly, measure, compare
The command karst generates caves, flies exploration policies through them in a
simulator, and writes a report of each flight. Localization, mapping, planning,
control and the flight home are included. Campaigns say which of several
policies is better, by how much, and how certain that is.

This package holds the command, its policies and its simulator.")

set(CPACK_DEBIAN_SDK_PACKAGE_NAME karst-sdk)
set(CPACK_DEBIAN_SDK_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_SDK_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_SDK_PACKAGE_RECOMMENDS "cmake, g++ | c++-compiler, make | ninja-build, karst")
set(CPACK_DEBIAN_SDK_DESCRIPTION
"headers to write exploration policies for karst
A policy chooses where a cave-flying UAV flies next. It is a shared object
behind a stable C ABI, in C or C++. This package holds the headers, a test kit
that needs no simulator, and the package that CMake's find_package(karst) finds.")

set(CPACK_DEBIAN_DOC_PACKAGE_NAME karst-doc)
set(CPACK_DEBIAN_DOC_PACKAGE_SECTION doc)
set(CPACK_DEBIAN_DOC_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_DOC_DESCRIPTION
"documentation and examples of karst
Tutorials, guides, reference and measured results of karst, which flies
exploration policies for cave-flying UAVs, and example missions, campaigns and
policies.")

if(TARGET karst_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME karst-python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "karst (= ${PROJECT_VERSION}), python3, python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "python3-matplotlib, python3-pandas")
  set(CPACK_DEBIAN_PYTHON_DESCRIPTION
"policies in Python for karst, its results as arrays, and an environment
With this package, karst flies exploration policies that are a class in a file of
Python. The module karst tests them, reads flights and campaigns as arrays and
data frames, plots them, and offers an environment to learn policies in.")
endif()

# Each package says under which license it is, where Debian's tools look.
foreach(part ${CPACK_COMPONENTS_ALL})
  string(TOUPPER ${part} upper)
  install(FILES ${PROJECT_SOURCE_DIR}/cmake/copyright COMPONENT ${part}
          DESTINATION share/doc/${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
endforeach()
include(CPack)
