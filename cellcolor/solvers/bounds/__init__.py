"""What holds for any division of the surface, whichever solver divides it: lower bounds, and what
can be left out."""
