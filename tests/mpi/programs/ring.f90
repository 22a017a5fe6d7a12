! ring.f90 - what of MPI differs in Fortran: module and mpif.h, handles, statuses, texts, places from one.
program ring
  use mpi
  implicit none
  integer :: rank, ranks, left, right, code, i, place, length, token, got(3), sums, type, op, half
  integer :: requests(3), status(MPI_STATUS_SIZE), statuses(MPI_STATUS_SIZE, 3), dims(2)
  integer(kind=MPI_ADDRESS_KIND) :: low, extent, largest
  logical :: flag, periods(2)
  double precision :: x(4), began
  character(len=MPI_MAX_PROCESSOR_NAME) :: name
  character(len=20) :: text
  external :: add

  call MPI_INIT(code)
  call MPI_COMM_RANK(MPI_COMM_WORLD, rank, code)
  call MPI_COMM_SIZE(MPI_COMM_WORLD, ranks, code)
  began = MPI_WTIME()
  right = mod(rank + 1, ranks)
  left = mod(rank + ranks - 1, ranks)

  ! three receives, completed by whichever comes; places count from one
  do i = 1, 3
    call MPI_IRECV(got(i), 1, MPI_INTEGER, left, i, MPI_COMM_WORLD, requests(i), code)
  end do
  do i = 3, 1, -1
    token = 10 * rank + i
    call MPI_SEND(token, 1, MPI_INTEGER, right, i, MPI_COMM_WORLD, code)
  end do
  call MPI_WAITANY(3, requests, place, status, code)
  if (place < 1 .or. place > 3) call MPI_ABORT(MPI_COMM_WORLD, 1, code)
  if (status(MPI_TAG) /= place .or. status(MPI_SOURCE) /= left) call MPI_ABORT(MPI_COMM_WORLD, 2, code)
  call MPI_GET_COUNT(status, MPI_INTEGER, length, code)
  if (length /= 1) call MPI_ABORT(MPI_COMM_WORLD, 3, code)
  call MPI_WAITALL(3, requests, statuses, code)
  do i = 1, 3
    if (got(i) /= 10 * left + i) call MPI_ABORT(MPI_COMM_WORLD, 4, code)
  end do

  ! signs for nothing, an operation of the program's own
  x = rank
  call MPI_ALLREDUCE(MPI_IN_PLACE, x, 4, MPI_DOUBLE_PRECISION, MPI_SUM, MPI_COMM_WORLD, code)
  if (any(x /= ranks * (ranks - 1) / 2)) call MPI_ABORT(MPI_COMM_WORLD, 5, code)
  call MPI_OP_CREATE(add, .true., op, code)
  call MPI_REDUCE(rank, sums, 1, MPI_INTEGER, op, 0, MPI_COMM_WORLD, code)
  if (rank == 0 .and. sums /= ranks * (ranks - 1) / 2) call MPI_ABORT(MPI_COMM_WORLD, 6, code)
  call MPI_OP_FREE(op, code)

  ! logicals, texts, addresses
  dims = 0
  periods = (/.true., .false./)
  call MPI_DIMS_CREATE(ranks, 2, dims, code)
  call MPI_CART_CREATE(MPI_COMM_WORLD, 2, dims, periods, .false., half, code)
  call MPI_COMM_SET_NAME(half, 'a grid', code)
  call MPI_COMM_GET_NAME(half, text, length, code)
  if (text /= 'a grid' .or. length /= 6) call MPI_ABORT(MPI_COMM_WORLD, 7, code)
  call MPI_COMM_FREE(half, code)
  if (half /= MPI_COMM_NULL) call MPI_ABORT(MPI_COMM_WORLD, 8, code)
  call MPI_TYPE_VECTOR(2, 1, 3, MPI_REAL8, type, code)
  call MPI_TYPE_COMMIT(type, code)
  call MPI_TYPE_GET_EXTENT(type, low, extent, code)
  if (extent /= 32) call MPI_ABORT(MPI_COMM_WORLD, 9, code)
  call MPI_TYPE_FREE(type, code)
  call MPI_COMM_GET_ATTR(MPI_COMM_WORLD, MPI_TAG_UB, largest, flag, code)
  if (.not. flag .or. largest < 32767) call MPI_ABORT(MPI_COMM_WORLD, 10, code)
  call MPI_GET_PROCESSOR_NAME(name, length, code)
  call old_style(rank, right, left)
  if (MPI_WTIME() <= began .or. MPI_WTIME() > began + 1) call MPI_ABORT(MPI_COMM_WORLD, 11, code)
  if (rank == 0) print '(a,i0,a)', 'ring of ', ranks, ' ranks is right'
  call MPI_FINALIZE(code)
end program ring

subroutine add(in, inout, n, type)
  integer :: n, type, in(n), inout(n)
  inout = inout + in
end subroutine add

! with the header of before modules, and reals sent by the call that sends integers above
subroutine old_style(rank, right, left)
  implicit none
  include 'mpif.h'
  integer :: rank, right, left, code
  real :: out, in
  out = rank
  call MPI_SENDRECV(out, 1, MPI_REAL, right, 9, in, 1, MPI_REAL, left, 9, MPI_COMM_WORLD, MPI_STATUS_IGNORE, code)
  if (in /= left) call MPI_ABORT(MPI_COMM_WORLD, 12, code)
end subroutine old_style
