"""What a user asks once the minimum is known: what do fewer lift-offs cover, and what costs one?"""
