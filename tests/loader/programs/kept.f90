! kept.f90 - what Fortran keeps: common blocks, modules, saved variables, units.
module kept
  integer :: n = 5
end module
subroutine count(me)
  use kept
  integer :: me, calls
  integer :: x
  common /block/ x
  save calls
  data calls /0/
  calls = calls + 1
  x = x + me
  n = n + me
  call nap()
  if (calls == 3) then
    print *, calls, x, n
    write (*, '(a,f6.3)') 'pi', acos(-1.0d0)
  end if
end subroutine
program main
  integer :: x, i
  common /block/ x
  character(20) :: text
  x = 0
  do i = 1, 3
    call count(rank())
  end do
  write (text, '(i5)') 17
  print '(a)', trim(text)
contains
  integer function rank()
    interface
      integer function getpid() bind(c)
      end function
    end interface
    rank = getpid() - 1000
  end function
end program
subroutine nap()
  interface
    integer function usleep(us) bind(c)
      integer, value :: us
    end function
  end interface
  integer :: i
  i = usleep(1)
end subroutine
