! mpi.f90 - the module of `use mpi`: what mpif.h declares.
module mpi
  implicit none
  include 'mpif.h'
end module mpi
