# mimdsim.cmake - toolchain file of CMake: programs for virtual processors, compiled by `mimdsim cc`, `c++` and `f90`.
#
#     cmake -DCMAKE_TOOLCHAIN_FILE=share/mimdsim/mimdsim.cmake -S . -B build
#
# mimdsim-cc is the one of the installation that this file belongs to, or lies in the folder MIMDSIM_FOLDER, or is found in
# PATH. What is built runs on virtual processors, also when CMake executes it to see what a computer can do.
set(MIMDSIM_FOLDER "" CACHE PATH "folder of mimdsim-cc")
find_program(MIMDSIM_CC_PROGRAM mimdsim-cc
  HINTS "${MIMDSIM_FOLDER}" "${CMAKE_CURRENT_LIST_DIR}/../../bin" "${CMAKE_CURRENT_LIST_DIR}/.."
        "${CMAKE_CURRENT_LIST_DIR}/../build")
if(NOT MIMDSIM_CC_PROGRAM)
  message(FATAL_ERROR "mimdsim-cc was not found; say -DMIMDSIM_FOLDER=/path/to/its/folder")
endif()
get_filename_component(mimdsim_folder "${MIMDSIM_CC_PROGRAM}" DIRECTORY)

# CMake asks the compilers what they are, and hears gcc's answers.
set(CMAKE_C_COMPILER "${mimdsim_folder}/mimdsim-cc")
set(CMAKE_CXX_COMPILER "${mimdsim_folder}/mimdsim-c++")
set(CMAKE_Fortran_COMPILER "${mimdsim_folder}/mimdsim-f90")

# Small projects that CMake makes to try something out read this file again, with this value.
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES MIMDSIM_FOLDER)
