"""What a discovery needs of a deck, and the cards its effects become."""
