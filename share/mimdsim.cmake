# mimdsim.cmake - toolchain file of CMake: programs for virtual processors, compiled by `mimdsim cc`, `c++` and `f90`.
#
#     cmake -DCMAKE_TOOLCHAIN_FILE=share/mimdsim/mimdsim.cmake -S . -B build
#
# mimdsim is the one of the installation that this file belongs to, or MIMDSIM_PROGRAM, or
# found in PATH. What is built runs on virtual processors, also when CMake executes it to see what a computer can do.
if(NOT MIMDSIM_PROGRAM)
  find_program(MIMDSIM_PROGRAM mimdsim NO_CMAKE_FIND_ROOT_PATH
    HINTS "${CMAKE_CURRENT_LIST_DIR}/../../bin" "${CMAKE_CURRENT_LIST_DIR}/.."
          "${CMAKE_CURRENT_LIST_DIR}/../build")
endif()
if(NOT MIMDSIM_PROGRAM)
  message(FATAL_ERROR "mimdsim was not found; say -DMIMDSIM_PROGRAM=/path/to/mimdsim")
endif()

# The compiler and its first argument; CMake asks it what it is, and hears gcc's answers.
set(CMAKE_C_COMPILER "${MIMDSIM_PROGRAM}" cc)
set(CMAKE_CXX_COMPILER "${MIMDSIM_PROGRAM}" c++)
set(CMAKE_Fortran_COMPILER "${MIMDSIM_PROGRAM}" f90)

# Projects of several folders configure each again, with this file and these values.
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES MIMDSIM_PROGRAM)

